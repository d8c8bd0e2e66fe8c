#!/usr/bin/env python3
"""Makes docs/results.md: what the gallery takes, and what bidirectional path tracing buys on each of its scenes.

    python3 benches/results.py [--binary PROGRAM] [--scenes a,b] [--time 10] [--reference-time 60]

Needs Python's standard library alone, and a release build of `caustica`. With the settings of the file that is kept,
it takes a quarter of an hour.
"""

import argparse
import datetime
import json
import platform
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SCENES = ["final", "glass", "long-way", "inverted", "bulb", "gap", "many-lamps", "veach-mi", "cornell", "furnace"]
# The reference work: samples a pixel, hours, and the resolution that is supposed.
CLASSIC_SAMPLES, CLASSIC_HOURS, CLASSIC_SIZE = 5000, 4, "800x600"
# A bidirectional path tracer of the usual kind: independent samples, one light path for each eye path, roulette after
# three bounces, no rays that are aimed.
CLASSIC = ["--sampler", "independent", "--roulette-depth", "3", "--aimed-rays", "0", "--shared-light-paths", "1"]
TIMED_PASSES = 8
SEEDS = 3


def parsed():
    """The command line's arguments."""
    p = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    p.add_argument("--binary", type=Path, default=ROOT / "target/release/caustica", help="the program")
    p.add_argument("--scenes", type=lambda t: t.split(","), default=SCENES, help="names of the gallery's scenes")
    p.add_argument("--size", default="400x300", help="of the pictures that are compared")
    p.add_argument("--time", type=float, default=10, help="seconds for each integrator and scene")
    p.add_argument("--reference-time", type=float, default=60, help="seconds for each reference")
    p.add_argument("--passes", type=int, default=32, help="samples a pixel from which the headline is worked out")
    p.add_argument("--output", type=Path, default=ROOT / "docs/results.md")
    return p.parse_args()


def caustica(options, *args):
    """What a run of the program tells as JSON."""
    ran = subprocess.run([options.binary, *map(str, args), "--json"], capture_output=True, text=True)
    if ran.returncode != 0:
        raise SystemExit(f"caustica {' '.join(map(str, args))}: {ran.stdout}{ran.stderr}")
    return json.loads(ran.stdout)


def processor():
    """The name of the CPU, where the system tells."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        return next(line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor() or platform.machine()


def scene_file(name):
    return ROOT / "scenes" / name / f"{name}.xml"


def seconds_a_pass(options, folder, more):
    """Seconds of one sample a pixel of `final` in the reference work's size."""
    told = caustica(options, "render", scene_file("final"), "--resolution", CLASSIC_SIZE, "--spp", TIMED_PASSES,
                    *more, "-o", folder / "timed")
    return told["seconds"] / told["samples"]


def errors(options, folder, more):
    """Trimmed relMSE of `passes` samples a pixel of `final`, of several seeds, without the reference's own error."""
    found = []
    for seed in range(1, SEEDS + 1):
        told = caustica(options, "compare", scene_file("final"), "--resolution", options.size, "--spp", options.passes,
                        "--integrators", "bdpt", "--seed", seed, *more,
                        "--reference", folder / "final" / "reference.exr", "-o", folder / "headline")
        found.append(told["entries"][0]["metrics"]["trimmed_rel_mse"])
    return found


def headline(options, folder, own):
    """The sentences about the reference work's samples. `own` is the reference's own relMSE."""
    print("the headline …", flush=True)
    n, mean = options.passes, lambda values: sum(values) / len(values)
    ours, classic = (errors(options, folder, more) for more in ([], CLASSIC))
    seconds, classic_seconds = (seconds_a_pass(options, folder, more) for more in ([], CLASSIC))
    hours = lambda samples, each: f"{samples * each / 3600:.2f} h"
    # Errors fall as 1/samples: the classic one's at its 5000 is reached by so many of ours.
    needed = (mean(ours) - own) / (mean(classic) - own) * CLASSIC_SAMPLES
    spread = lambda values: ", ".join(f"{v:.4f}" for v in values)
    return f"""The reference work rendered `final` with {CLASSIC_SAMPLES} samples a pixel in {CLASSIC_HOURS} hours, on its machine of 2013. Its
resolution is not told; {CLASSIC_SIZE.replace("x", " × ")} is supposed.

| | |
|---|--:|
| time of {CLASSIC_SAMPLES} samples a pixel here | **{hours(CLASSIC_SAMPLES, seconds)}** |
| the same for a classic bdpt here | {hours(CLASSIC_SAMPLES, classic_seconds)} |
| trimmed relMSE of {n} samples, seeds 1 to {SEEDS} | {spread(ours)} |
| the same for a classic bdpt | {spread(classic)} |
| samples that have the error of the classic one's {CLASSIC_SAMPLES} | {needed:.0f} |
| time of these | **{hours(needed, seconds)}** |

*Classic* is ours with independent samples, one light path for each eye path, without aimed rays and with roulette after
three bounces: `{" ".join(CLASSIC)}`. It still looks for
lamps by solid angle and leaves out what is negligible. Times are those of {TIMED_PASSES} passes, scaled: every pass takes the same.
Errors are measured at {options.size.replace("x", " × ")}, without the reference's own, and taken to fall as one over the number of samples; that
ours fall a little faster is not counted.
"""


def table(options, folder):
    """What path and bdpt come to on each scene, as rows of a table; the first reference's own error; and notes."""
    rows, owns, notes = [], {}, {}
    for name in options.scenes:
        print(f"{name} …", flush=True)
        told = caustica(options, "compare", scene_file(name), "--resolution", options.size,
                        "--integrators", "path,bdpt", "--time", options.time,
                        "--reference-time", options.reference_time, "-o", folder / name)
        path, bdpt = (entry["metrics"] for entry in told["entries"])
        notes = dict(told["notes"])
        own = owns[name] = float(notes["reference's own relMSE"])

        def speed_up(key):
            """By errors times seconds, the reference's own error left out of both."""
            above, below = (m[key] and (m[key] - own) * m["seconds"] for m in (path, bdpt))
            return f"**{above / below:.2g}**" if above and below and above > 0 and below > own * bdpt["seconds"] else "–"

        show = lambda value, form: "–" if value is None else format(value, form)
        cells = [show(m[k], ".3g") for k in ("rel_mse", "trimmed_rel_mse") for m in (path, bdpt)]
        cells += [speed_up("rel_mse"), speed_up("trimmed_rel_mse")]
        cells += [show(m["flip"], ".3f") for m in (path, bdpt)] + [f"{own:.2g}"]
        rows.append(f"| [{name}](../scenes/{name}/README.md) | " + " | ".join(cells) + " |")
    return "\n".join(rows), owns, notes


OWN_SECTIONS = ("The reference work's picture", "What light paths buy")


def sections_of_others(output):
    """What the file holds beside the sections that are made here."""
    text = output.read_text() if output.exists() else ""
    sections = text.split("\n## ")[1:]
    return "".join(f"\n## {s.rstrip()}\n" for s in sections if not s.startswith(OWN_SECTIONS))


def main():
    options = parsed()
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        rows, owns, notes = table(options, folder)
        first = headline(options, folder, owns["final"]) if "final" in owns else ""
    options.output.write_text(f"""# Results

Made by `benches/results.py` on {datetime.date.today().strftime("%d %B %Y").lstrip("0")}: Caustica {notes["version"]} on {notes["threads"]} threads, {processor()}.

## The reference work's picture

{first}
## What light paths buy

`path` and `bdpt`, {options.time:g} s each, {notes["size"]}, against {options.reference_time:g} s of `bdpt` with other seeds
(`caustica compare`). The speed-up is how much sooner `bdpt` has the same error: the ratio of errors times that of
seconds, without the reference's own error, for errors fall as one over time. Where it is below one, `path` is the
better choice; where `bdpt` is as good as its reference, none is told. *Trimmed* leaves out the 0.1 % worst pixels.

| scene | relMSE: `path` | `bdpt` | trimmed: `path` | `bdpt` | speed-up | trimmed | ꟻLIP: `path` | `bdpt` | reference's own |
|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|
{rows}
{sections_of_others(options.output)}""")
    print(f"wrote {options.output}")


if __name__ == "__main__":
    main()
