#!/usr/bin/env python3
"""Renders Mitsuba scenes with Mitsuba and with Caustica, and compares the pictures.

    python3 -m venv venv && venv/bin/pip install mitsuba numpy
    cargo build --release
    venv/bin/python peers/mitsuba/compare.py [SCENE...] [--samples N] [--integrators path,bdpt]

Without scenes: all of `peers/mitsuba/scenes`. A scene passes if the means agree within 0.5 % and the median over
blocks of 8 x 8 pixels of |ours/theirs - 1| is at most 1 %, both beyond what the noise of the pictures explains.
Ends with 1 if one does not.
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile

import mitsuba
import numpy

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
BLOCK = 8
PARTS = 4  # Pictures by different seeds, whose differences tell the noise.


def luminance(picture):
    return picture[..., :3] @ numpy.array([0.212671, 0.715160, 0.072169])


def theirs(scene, samples, seed):
    loaded = mitsuba.load_file(str(scene))
    picture = mitsuba.render(loaded, spp=samples, seed=seed)
    return luminance(numpy.array(picture, dtype=numpy.float64))


def ours(program, scene, integrator, samples, seed, folder):
    out = folder / f"{scene.stem}-{integrator}-{seed}.exr"
    command = [program, "render", scene, "-o", out, "--integrator", integrator, "--spp", samples, "--seed", seed]
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    layers = dict(mitsuba.Bitmap(str(out)).split())
    return luminance(numpy.array(layers["combined"], dtype=numpy.float64))


def blocks(picture):
    height, width = (side // BLOCK * BLOCK for side in picture.shape)
    cut = picture[:height, :width].reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK)
    return cut.mean(axis=(1, 3))


def summary(pictures):
    """The mean, the blocks, and the standard errors of both."""
    means = numpy.array([p.mean() for p in pictures])
    cut = numpy.array([blocks(p) for p in pictures])
    root = numpy.sqrt(len(pictures))
    return means.mean(), means.std(ddof=1) / root, cut.mean(axis=0), cut.std(axis=0, ddof=1) / root


def integrators(scene, options):
    """What only light paths find is left to those of ours that have them."""
    asked = options.integrators.split(",")
    if 'type="ptracer"' in scene.read_text():
        return ["light" if integrator == "path" else integrator for integrator in asked]
    return asked


def compare(a, b):
    (mean_a, error_a, blocks_a, noise_a), (mean_b, error_b, blocks_b, noise_b) = a, b
    if mean_b == 0.0:
        sys.exit("Mitsuba's picture is black")
    ratio = mean_a / mean_b
    uncertain = 3.0 * numpy.hypot(error_a, error_b) / mean_b
    lit = blocks_b > 0.01 * blocks_b.mean()
    off = numpy.abs(blocks_a / numpy.maximum(blocks_b, 1e-30) - 1.0)[lit]
    noise = (numpy.hypot(noise_a, noise_b) / numpy.maximum(blocks_b, 1e-30))[lit]
    median, noise = float(numpy.median(off)), float(numpy.median(noise))
    passes = abs(ratio - 1.0) <= 0.005 + uncertain and median <= 0.01 + noise
    return passes, ratio, uncertain, median, noise, float(off.max())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", type=pathlib.Path)
    parser.add_argument("--samples", type=int, default=1024, help="a pixel, of each program")
    parser.add_argument("--integrators", default="path,bdpt")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "target/release/caustica")
    options = parser.parse_args()
    mitsuba.set_variant("scalar_rgb")
    mitsuba.set_log_level(mitsuba.LogLevel.Error)
    scenes = options.scenes or sorted((HERE / "scenes").glob("*.xml"))
    samples = max(1, options.samples // PARTS)
    good = True
    print("| scene | by | mean, ours : theirs | blocks' median difference | noise of a block | worst block |")
    print("|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for scene in scenes:
            reference = summary([theirs(scene, samples, seed) for seed in range(PARTS)])
            for integrator in integrators(scene, options):
                pictures = [
                    ours(options.program, scene, integrator, samples, seed, pathlib.Path(folder))
                    for seed in range(PARTS)
                ]
                passes, ratio, uncertain, median, noise, worst = compare(summary(pictures), reference)
                good &= passes
                mark = "" if passes else " **differs**"
                print(
                    f"| `{scene.stem}` | `{integrator}` | {ratio:.4f} ± {uncertain:.4f}{mark} | {median:.2%}"
                    f" | {noise:.2%} | {worst:.1%} |",
                    flush=True,
                )
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
