#!/usr/bin/env python3
"""Compares the layers that Caustica and Mitsuba write beside a picture: those of the `aov` integrator.

    venv/bin/python peers/mitsuba/layers.py [--program target/release/caustica] [--samples 1024]

Caustica makes layers of 64 samples a pixel at most; Mitsuba takes as many as it is told. What is told of each channel
is the median over pixels of the difference, the part of the pixels that differ by more than 10^-3 (in units of the
channel's largest value, if that is more than one), and the difference of the means in that unit. Where edges cross a
pixel both have noise: the median and the means tell whether they agree. Ends with 1 if either is above 10^-3 in any
channel.
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile

import numpy

import compare
from compare import ROOT, SCENES, mitsuba

SCENE = SCENES / "integrator_aov.xml"
# What another number stands for here.
INDICES = {"shape.I", "triangle.I"}


def theirs(samples):
    scene = mitsuba.load_file(str(SCENE))
    names = scene.integrator().aov_names()
    each = min(samples, 256)
    runs = -(-samples // each)
    pictures = [numpy.array(mitsuba.render(scene, spp=each, seed=run), dtype=numpy.float64) for run in range(runs)]
    picture = numpy.mean(pictures, axis=0)
    first = picture.shape[-1] - len(names)
    channels = {name: picture[..., first + i] for i, name in enumerate(names)}
    # Mitsuba shrinks the footprint of a sample by the square root of their number.
    return {n: c * each**0.5 if n.startswith(("right.", "down.")) else c for n, c in channels.items()}


def ours(program):
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "picture.exr"
        command = [program, "render", SCENE, "-o", out, "--spp", 64, "-q"]
        subprocess.run([str(word) for word in command], check=True)
        layers = dict(mitsuba.Bitmap(str(out)).split())
        channels = {}
        for layer, bitmap in layers.items():
            values = numpy.array(bitmap, dtype=numpy.float64)
            fields = [bitmap.struct_()[i].name for i in range(bitmap.channel_count())]
            for i, field in enumerate(fields):
                channels[f"{layer}.{field}"] = values if values.ndim == 2 else values[..., i]
        return channels


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "target/release/caustica")
    parser.add_argument("--samples", type=int, default=1024, help="a pixel, of Mitsuba")
    parser.add_argument("--variant", help="of Mitsuba; llvm_ad_rgb if it can be had, else scalar_rgb")
    options = parser.parse_args()
    compare.set_variant(options.variant)
    compare.assets.make()
    mine, other = ours(options.program), theirs(options.samples)
    print("| channel | median difference | beyond 10⁻³ | of the means |\n|---|---|---|---|")
    good = True
    for name in sorted(set(other) - {n for n in other if n.startswith("picture.")} - INDICES):
        if name not in mine:
            print(f"| `{name}` | missing | | |")
            good = False
            continue
        # A pixel without a surface has no derivatives, which Mitsuba takes for no numbers.
        a, b = mine[name], numpy.nan_to_num(other[name])
        unit = max(1.0, numpy.abs(b).max())
        off = numpy.abs(a - b) / unit
        mean = abs(a.mean() - b.mean()) / unit
        print(f"| `{name}` | {numpy.median(off):.1e} | {(off > 1e-3).mean():.1%} | {mean:.1e} |")
        good &= bool(numpy.median(off) <= 1e-3 and mean <= 1e-3)
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
