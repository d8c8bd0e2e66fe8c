"""Makes the figures of `published.rs`: ꟻLIP by the evaluator that its authors publish, relMSE by `benches/peers`.

    pip install flip-evaluator==1.7 numpy
    python published.py

prints the two tables of that file. The pictures are made of whole numbers and powers of two, so that
`pictures.rs` makes the same pixels to the bit. The figures in the repository were made with flip-evaluator 1.7 and
numpy 2.4.6.
"""

import sys
from pathlib import Path

import flip_evaluator
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[4] / "benches" / "peers"))
import metrics  # noqa: E402


def noise(width, height, seed):
    """Three channels of noise in [0, 1), multiples of 2⁻²⁴; the hash is Chris Wellons' lowbias32."""
    h = np.arange(3 * width * height, dtype=np.uint32) + np.uint32(1_000_003 * seed)
    h = (h ^ (h >> np.uint32(16))) * np.uint32(0x7FEB352D)
    h = (h ^ (h >> np.uint32(15))) * np.uint32(0x846CA68B)
    h = (h ^ (h >> np.uint32(16))) >> np.uint32(8)
    return (h.astype(np.float32) / np.float32(1 << 24)).reshape(height, width, 3)


def coordinates(width, height):
    return np.meshgrid(np.arange(width), np.arange(height))


def picture(*channels):
    return np.ascontiguousarray(np.stack(np.broadcast_arrays(*channels), axis=-1), dtype=np.float32)


def checks(width, height, shift):
    """Coloured checks of 8 × 8 pixels, moved to the right."""
    x, y = coordinates(width, height)
    odd = ((x + shift) // 8 + y // 8) % 2
    return picture(0.75 * odd + 0.125, 0.5 * odd, 0.25 + 0.25 * odd)


def ramps(width, height, levels):
    """A ramp of another direction in each channel, in so many levels."""
    x, y = coordinates(width, height)
    return picture((x * levels // width) / levels, (y * levels // height) / levels, 1 - (x * levels // width) / levels)


def speckled(reference, amount, seed):
    """The reference with noise that may be negative, cut off at black."""
    n = noise(reference.shape[1], reference.shape[0], seed)
    return np.maximum(reference + np.float32(amount) * (n - np.float32(0.5)), np.float32(0))


def room(width, height, lamp):
    """Dim ramps with a lamp in them."""
    x, y = coordinates(width, height)
    light = ramps(width, height, 64) * np.float32(0.5) + np.float32(1 / 64)
    light[(abs(x - width // 2) < 6) & (abs(y - height // 4) < 3)] = lamp
    return light


def fireflies(reference, value, seed):
    """The reference with about every two-hundredth pixel as bright as told."""
    hit = noise(reference.shape[1], reference.shape[0], seed)[..., 0] < 1 / 200
    return np.where(hit[..., None], np.float32(value), reference)


def night(width, height):
    """Black but for a bar at the left."""
    x, _ = coordinates(width, height)
    bar = np.where(x < 12, 4, 0)
    return picture(bar, bar / 2, bar / 4)


def cases():
    """Name, test picture, reference, and what differs from the evaluator's defaults."""
    flat, lit, dark = ramps(96, 64, 128), room(96, 64, 1024), night(96, 64)
    small = room(37, 23, 8)
    shown = np.minimum(small, np.float32(1))
    yield "ldr_edges", checks(96, 64, 2), checks(96, 64, 0), {}
    yield "ldr_ramps", ramps(96, 64, 8), flat, {}
    yield "ldr_noise", np.minimum(speckled(flat, 0.5, 1), np.float32(1)), flat, {}
    yield "ldr_faint", np.minimum(speckled(flat, 1 / 64, 2), np.float32(1)), flat, {}
    yield "ldr_opposite", picture(*3 * [np.zeros((64, 96))]), picture(*3 * [np.ones((64, 96))]), {}
    yield "ldr_near", np.minimum(speckled(small, 0.25, 3), np.float32(1)), shown, {"ppd": 20.0}
    yield "hdr_noise", speckled(lit, 0.5, 4), lit, {}
    yield "hdr_fireflies", fireflies(lit, 4096, 5), lit, {}
    yield "hdr_night", speckled(dark, 0.125, 6), dark, {}
    yield "hdr_same", lit, lit, {}
    yield "hdr_small", speckled(small, 0.5, 7), small, {"ppd": 40.0}
    yield "hdr_reinhard", speckled(lit, 0.5, 4), lit, {"tonemapper": "reinhard"}
    yield "hdr_hable", speckled(lit, 0.5, 4), lit, {"tonemapper": "hable"}
    yield "hdr_given", speckled(lit, 0.5, 4), lit, {"startExposure": -2.0, "stopExposure": 3.0, "numExposures": 4}


def flip_line(name, test, reference, parameters):
    """Mean, three pixels, and the exposures."""
    values, _, used = flip_evaluator.evaluate(
        reference, test, name[:3].upper(), inputsRGB=False, applyMagma=False, parameters=parameters)
    values = values[..., 0]
    height, width = values.shape
    probes = [values[y, x] for x, y in ((0, 0), (width // 3, height // 2), (width // 2, height // 4 + 3))]
    exposures = "None"
    if name.startswith("hdr"):
        exposures = f"Some(({used['startExposure']:.5}, {used['stopExposure']:.5}, {used['numExposures']}))"
    return f'("{name}", {values.mean(dtype=float):.6f}, [{", ".join(f"{p:.5f}" for p in probes)}], {exposures}),'


def error_line(name, test, reference):
    """relMSE, trimmed relMSE, RMSE, and the mean luminance."""
    rmse = np.mean((test.astype(float) - reference) ** 2) ** 0.5
    figures = (metrics.rel_mse(test, reference), metrics.rel_mse(test, reference, trim=0.001), rmse,
               metrics.luminance(test.astype(float)).mean())
    return f'("{name}", [{", ".join(f"{x:.9e}" for x in figures)}]),'


def main():
    chosen = list(cases())
    print(*(flip_line(*case) for case in chosen), sep="\n")
    print(*(error_line(*case[:3]) for case in chosen if not case[3]), sep="\n")


if __name__ == "__main__":
    main()
