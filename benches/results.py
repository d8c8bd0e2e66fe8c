#!/usr/bin/env python3
"""Makes docs/results.md: what the gallery takes, and what bidirectional path tracing buys on each of its scenes.

    python3 benches/results.py [--binary PROGRAM] [--scenes a,b] [--time 10] [--reference-time 60]

Needs Python's standard library alone, and a release build of `caustica`. With the settings of the file that is kept,
it takes about half an hour; what it finds goes to docs/results.md.
"""

import argparse
import datetime
import json
import os
import platform
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SCENES = ["final", "glass", "long-way", "inverted", "bulb", "gap", "many-lamps", "veach-mi", "cornell", "furnace"]
# The reference work: samples a pixel, hours, and the resolution that is supposed.
CLASSIC_SAMPLES, CLASSIC_HOURS, CLASSIC_SIZE = 5000, 4, "800x600"
# A bidirectional path tracer of the usual kind: independent samples, roulette after three bounces.
CLASSIC = ["--sampler", "independent", "--roulette-depth", "3"]


def parsed():
    """The command line's arguments."""
    p = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    p.add_argument("--binary", type=Path, default=ROOT / "target/release/caustica", help="the program")
    p.add_argument("--scenes", type=lambda t: t.split(","), default=SCENES, help="names of the gallery's scenes")
    p.add_argument("--size", default="400x300", help="of the pictures that are compared")
    p.add_argument("--time", type=float, default=10, help="seconds for each integrator and scene")
    p.add_argument("--reference-time", type=float, default=60, help="seconds for each reference")
    p.add_argument("--passes", type=int, default=48, help="samples a pixel from which the headline is worked out")
    p.add_argument("--output", type=Path, default=ROOT / "docs/results.md")
    return p.parse_args()


def caustica(options, *args):
    """What a run of the program tells as JSON."""
    ran = subprocess.run([options.binary, *map(str, args), "--json"], capture_output=True, text=True)
    if ran.returncode != 0:
        raise SystemExit(f"caustica {' '.join(map(str, args))}: {ran.stdout}{ran.stderr}")
    return json.loads(ran.stdout)


def scene_file(name):
    return ROOT / "scenes" / name / f"{name}.xml"


def between(options, folder, more, seeds):
    """relMSE and trimmed relMSE of one picture of `final` (half of what two independent ones differ by), and seconds."""
    args = [scene_file("final"), "--resolution", CLASSIC_SIZE, "--spp", options.passes, *more]
    made = caustica(options, "render", *args, "--seed", seeds[0], "-o", folder / "half")
    told = caustica(options, "compare", *args, "--integrators", "bdpt", "--seed", seeds[1],
                    "--reference", folder / "half.exr", "-o", folder / "difference")
    metrics = told["entries"][0]["metrics"]
    return metrics["rel_mse"] / 2, metrics["trimmed_rel_mse"] / 2, (made["seconds"] + metrics["seconds"]) / 2


def headline(options, folder):
    """The sentences about the reference work's samples."""
    n = options.passes
    print(f"final, {n} samples: this renderer …", flush=True)
    _, trimmed, seconds = between(options, folder, [], (1, 2))
    print(f"final, {n} samples: a classic bdpt …", flush=True)
    _, classic, classic_seconds = between(options, folder, CLASSIC, (3, 4))
    hours = seconds / n * CLASSIC_SAMPLES / 3600
    # Errors fall as 1/samples: the classic one's at its 5000 is reached by so many of ours.
    needed = trimmed / classic * CLASSIC_SAMPLES
    same = seconds / n * needed / 3600
    return f"""The reference work rendered `final` with {CLASSIC_SAMPLES} samples a pixel in {CLASSIC_HOURS} hours on its machine of
2013 (its resolution is not told; {CLASSIC_SIZE.replace("x", " × ")} is supposed).

| | |
|---|--:|
| time of {CLASSIC_SAMPLES} samples a pixel here | {hours:.2f} h |
| relMSE of {n} samples, without the 0.1 % worst pixels | {trimmed:.4f} |
| the same for a classic bdpt ({n} independent samples, roulette after three bounces) | {classic:.4f} |
| samples that have the error of the classic one's {CLASSIC_SAMPLES} | {needed:.0f} |
| time of these | {same:.2f} h |
| time of the classic one's {CLASSIC_SAMPLES} samples here | {classic_seconds / n * CLASSIC_SAMPLES / 3600:.2f} h |

Worked out from {n} passes of each, timed: every pass takes the same time, and the error of independent samples falls as
one over their number. (That of ours falls a little faster, which is not counted.) The error is half of what two pictures
of different seeds differ by.
"""


def table(options, folder):
    """What path and bdpt come to on each scene, as rows of a table."""
    rows = []
    for name in options.scenes:
        print(f"{name} …", flush=True)
        told = caustica(options, "compare", scene_file(name), "--resolution", options.size,
                        "--integrators", "path,bdpt", "--time", options.time,
                        "--reference-time", options.reference_time, "-o", folder / name)
        path, bdpt = (entry["metrics"] for entry in told["entries"])
        own = next((value for note, value in told["notes"] if "own" in note), "–")
        errors = " | ".join(f"{m[k]:.3g}" for k in ("rel_mse", "trimmed_rel_mse") for m in (path, bdpt))
        ratios = " | ".join(f"{path[k] / bdpt[k]:.3g}" for k in ("rel_mse", "trimmed_rel_mse"))
        flip = " | ".join(f"{m['flip']:.3f}" if m["flip"] is not None else "–" for m in (path, bdpt))
        rows.append(f"| [{name}](../scenes/{name}/README.md) | {errors} | **{ratios.split(' | ')[0]}** | "
                    f"**{ratios.split(' | ')[1]}** | {flip} | {own.removeprefix('about ')} |")
    return "\n".join(rows)


def main():
    options = parsed()
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        rows = table(options, folder)
        first = headline(options, folder)
    threads = os.cpu_count()
    options.output.write_text(f"""# Results

Made by `python3 benches/results.py` on {datetime.date.today():%d %B %Y}, on {platform.machine()} with {threads} threads.

## The reference work's picture

{first}
## What light paths buy

`path` and `bdpt`, {options.time:.0f} s each on {threads} threads, {options.size.replace("x", " × ")} pixels, against {options.reference_time:.0f} s of `bdpt` with other seeds (`caustica
compare`). The speed-up is the ratio of errors, which for independent samples is that of times to the same error; where
it is below one, `path` is the better choice. *Trimmed* leaves out the 0.1 % worst pixels. An error near the reference's
own, in the last column, says little.

| scene | relMSE `path` | `bdpt` | trimmed `path` | `bdpt` | speed-up | trimmed | ꟻLIP `path` | `bdpt` | reference's own relMSE |
|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|
{rows}
""")
    print(f"wrote {options.output}")


if __name__ == "__main__":
    main()
