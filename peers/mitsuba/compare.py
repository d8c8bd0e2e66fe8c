#!/usr/bin/env python3
"""Renders Mitsuba scenes with Mitsuba and with Caustica, and compares the pictures.

    python3 -m venv venv && venv/bin/pip install mitsuba numpy
    cargo build --release
    venv/bin/python peers/mitsuba/compare.py [SCENE...] [--samples N] [--integrators path,bdpt] [--write]

Without scenes: all of `peers/mitsuba/scenes`. A scene passes if the means agree within 0.5 % and the median over
blocks of 8 x 8 pixels of |ours/theirs - 1| is at most 1 %. What is off by more is called noise if three standard
errors explain it, and a difference otherwise. A single block that is off by more than 5 % and six of its standard
errors is a local difference, whatever the rest. Ends with 1 if anything but passes was found. `--write` puts the table
into docs/results.md. Mitsuba's pictures are kept, outside of the repository, until the scene or Mitsuba changes.

A comment `<!-- compare: by=path,light samples=4096 -->` in a scene says what it is compared by, and with how many
samples a pixel.
"""

import argparse
import dataclasses
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
SCENES = HERE / "scenes"
RESULTS = ROOT / "docs" / "results.md"
HEADING = "## Compared with Mitsuba"
BLOCK = 8
PARTS = 4  # Pictures by different seeds, whose differences tell the noise.
MOST_AT_A_TIME = 1 << 21  # Samples that Mitsuba's vectorised variants hold at once.

LLVM = pathlib.Path(sys.prefix) / "llvm/usr/lib"
for library in sorted(LLVM.glob("*/libLLVM.so*")):
    os.environ.setdefault("DRJIT_LIBLLVM_PATH", str(library))
import mitsuba  # noqa: E402  (it looks for LLVM when it is loaded)

import assets  # noqa: E402


@dataclasses.dataclass
class Verdict:
    """What the comparison of two pictures says."""

    ratio: float
    error: float  # One standard error of the ratio.
    median: float
    noise: float
    worst: float
    local: int  # Blocks that are off by more than 5 % and six standard errors.

    @property
    def word(self):
        if self.local:
            return f"**differs in {self.local} blocks**"
        if abs(self.ratio - 1.0) <= 0.005 and self.median <= 0.01:
            return "passes"
        explained = abs(self.ratio - 1.0) <= 0.005 + 3.0 * self.error and self.median <= 0.01 + self.noise
        return "noise" if explained else "**differs**"


def luminance(picture):
    if picture.shape[-1] < 3:
        return picture[..., 0]
    return picture[..., :3] @ numpy.array([0.212671, 0.715160, 0.072169])


def fingerprint(scene):
    """Of all that Mitsuba's picture depends on: the scene, what scenes include, and what makes their assets."""
    digest = hashlib.sha256(mitsuba.__version__.encode() + mitsuba.variant().encode())
    for path in [scene, *sorted((SCENES / "parts").glob("*.xml")), HERE / "assets.py"]:
        digest.update(path.read_bytes())
    return digest.hexdigest()[:20]


def theirs(scene, samples, cache):
    """Mitsuba's pictures, one a part."""
    kept = cache / f"{scene.stem}-{samples}-{fingerprint(scene)}.npy"
    if kept.exists():
        return numpy.load(kept)
    loaded = mitsuba.load_file(str(scene))
    width, height = loaded.sensors()[0].film().crop_size()
    each = max(1, min(samples, MOST_AT_A_TIME // (width * height)))
    runs = -(-samples // each)
    parts = []
    for part in range(PARTS):
        pictures = [mitsuba.render(loaded, spp=each, seed=1000 * part + run) for run in range(runs)]
        parts.append(numpy.mean([luminance(numpy.array(p, dtype=numpy.float64)) for p in pictures], axis=0))
    cache.mkdir(parents=True, exist_ok=True)
    numpy.save(kept, parts)
    return numpy.array(parts)


def ours(program, scene, integrator, samples):
    """Caustica's pictures, one a part; or why there are none."""
    parts = []
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "picture.exr"
        for seed in range(PARTS):
            command = [program, "render", scene, "-o", out, "--integrator", integrator, "--spp", samples, "--seed", seed]
            done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
            if done.returncode != 0:
                return done.stderr.strip().splitlines()[0]
            layers = dict(mitsuba.Bitmap(str(out)).split())
            parts.append(luminance(numpy.array(layers["combined"], dtype=numpy.float64)))
    return numpy.array(parts)


def blocks(picture):
    tall, wide = (min(BLOCK, side) for side in picture.shape)
    rows, columns = picture.shape[0] // tall, picture.shape[1] // wide
    cut = picture[: rows * tall, : columns * wide].reshape(rows, tall, columns, wide)
    return cut.mean(axis=(1, 3))


def summary(pictures):
    """The mean, the blocks, and the standard errors of both."""
    means = numpy.array([p.mean() for p in pictures])
    cut = numpy.array([blocks(p) for p in pictures])
    root = numpy.sqrt(len(pictures))
    return means.mean(), means.std(ddof=1) / root, cut.mean(axis=0), cut.std(axis=0, ddof=1) / root


def compare(a, b):
    (mean_a, error_a, blocks_a, noise_a), (mean_b, error_b, blocks_b, noise_b) = summary(a), summary(b)
    if mean_b == 0.0:
        raise ValueError("Mitsuba's picture is black")
    lit = blocks_b > 0.01 * blocks_b.mean()
    off = numpy.abs(blocks_a[lit] / blocks_b[lit] - 1.0)
    noise = numpy.hypot(noise_a, noise_b)[lit] / blocks_b[lit]
    error = float(numpy.hypot(error_a, error_b) / mean_b)
    # Four pictures tell a block's noise badly: no block has less than the median.
    local = int(numpy.sum(off > 0.05 + 6.0 * numpy.maximum(noise, numpy.median(noise))))
    return Verdict(mean_a / mean_b, error, float(numpy.median(off)), float(numpy.median(noise)), float(off.max()), local)


def wishes(scene, options):
    """By what a scene is compared, and by how many samples a pixel."""
    found = re.search(r"<!-- compare: (.*?) -->", scene.read_text())
    told = dict(word.split("=") for word in found[1].split()) if found else {}
    by = told.get("by", options.integrators).split(",")
    return by, int(told["samples"]) if "samples" in told else options.samples


def rows(scene, options):
    """One row of the table for each integrator, with whether it passes."""
    by, samples = wishes(scene, options)
    samples = max(1, samples // PARTS)
    try:
        reference = theirs(scene, options.reference * samples, options.cache)
    except RuntimeError as why:
        yield f"| `{scene.stem}` | Mitsuba: {str(why).strip().splitlines()[-1][:120]} | | | | |", False
        return
    for integrator in by:
        pictures = ours(options.program, scene, integrator, samples)
        if isinstance(pictures, str):
            yield f"| `{scene.stem}` | `{integrator}` | {pictures[:160]} | | | **differs** |", False
            continue
        v = compare(pictures, reference)
        yield (
            f"| `{scene.stem}` | `{integrator}` | {v.ratio:.4f} ± {v.error:.4f} | {v.median:.2%} ± {v.noise:.2%}"
            f" | {v.worst:.1%} | {v.word} |",
            v.word == "passes",
        )


def store(table, options):
    """Puts the table into docs/results.md, in place of the one that is there."""
    theirs = options.samples * options.reference
    text = f"""{HEADING}

Made by `peers/mitsuba/compare.py`: each plugin that both read, in a small scene of `peers/mitsuba/scenes` (or as it says
there). {options.samples} samples a pixel of Caustica, {theirs} of Mitsuba {mitsuba.__version__} (`{mitsuba.variant()}`), unless the scene
asks for more. A row passes if the means are within 0.5 % and the median over blocks of 8 × 8 pixels of their difference
is within 1 %; ± is one standard error. [mitsuba.md](mitsuba.md) says what is known to differ.

{table}
"""
    before, _, rest = RESULTS.read_text().partition(HEADING)
    after = "\n## " + rest.partition("\n## ")[2] if "\n## " in rest else ""
    RESULTS.write_text(before.rstrip() + "\n\n" + text + after)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", type=pathlib.Path)
    parser.add_argument("--samples", type=int, default=1024, help="a pixel")
    parser.add_argument("--reference", type=int, default=1, help="how many times as many Mitsuba takes")
    parser.add_argument("--integrators", default="path,bdpt")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "target/release/caustica")
    parser.add_argument("--variant", help="of Mitsuba; llvm_ad_rgb if it can be had, else scalar_rgb")
    usual = pathlib.Path(os.environ.get("XDG_CACHE_HOME", pathlib.Path.home() / ".cache")) / "caustica-mitsuba"
    parser.add_argument("--cache", type=pathlib.Path, default=usual, help="where Mitsuba's pictures are kept")
    parser.add_argument("--write", action="store_true", help="put the table into docs/results.md")
    options = parser.parse_args()
    set_variant(options.variant)
    assets.make()
    good = True
    lines = [
        "| scene | by | mean, ours : theirs | blocks' median difference | worst block | |",
        "|---|---|---|---|---|---|",
    ]
    print("\n".join(lines))
    for scene in options.scenes or sorted(SCENES.glob("*.xml")):
        for line, passes in rows(scene.resolve(), options):
            good &= passes
            lines.append(line)
            print(line, flush=True)
    if options.write:
        store("\n".join(lines), options)
    sys.exit(0 if good else 1)


def set_variant(wanted):
    for variant in [wanted] if wanted else ["llvm_ad_rgb", "scalar_rgb"]:
        try:
            mitsuba.set_variant(variant)
            mitsuba.Float(1.0) + mitsuba.Float(1.0)
            break
        except (ImportError, RuntimeError):
            if wanted:
                raise
    mitsuba.set_log_level(mitsuba.LogLevel.Error)


if __name__ == "__main__":
    main()
