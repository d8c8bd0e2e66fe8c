#!/usr/bin/env python3
"""Whole frames: instructions and time a sample, and the ratio to another build.

    python3 benches/frames.py                                    # all scenes there are, bdpt and path
    python3 benches/frames.py --compare ../old/target/release/caustica --scenes built-in
    python3 benches/frames.py --repeats 0                        # instructions alone: no quiet machine needed

Instructions are those of a render of three samples a pixel, less those of one, so that loading cancels; callgrind
counts them, but for the writing of the picture; one thread runs. Times are medians of renders, the two programs taking
turns; a ratio is the median of the turns' ratios, this program's time over the other's, and comes with its quartiles.
"""

import argparse
from pathlib import Path
from statistics import median, quantiles

import measure


def instructions(binary, scene, integrator, work):
    """Instructions a sample."""
    counts = []
    for samples in (1, 3):
        file = measure.callgrind(binary, scene, integrator, samples, work)
        counts.append(measure.instructions(file))
        file.unlink()
    return (counts[1] - counts[0]) / (2 * measure.SIZE[0] * measure.SIZE[1])


def times(binaries, scene, integrator, options):
    """Microseconds a sample: for each repeat one for every program."""
    samples = options.spp
    scale = 1e6 / (samples * measure.SIZE[0] * measure.SIZE[1])
    return [[measure.seconds(b, scene, integrator, samples, options.work) * scale for b in binaries]
            for _ in range(options.repeats)]


def timed(repeats):
    """Those times, in words."""
    if not repeats:
        return ""
    own = [r[0] for r in repeats]
    text = f"{median(own):8.2f} µs (best {min(own):.2f})"
    if len(repeats[0]) > 1:
        ratios = [r[0] / r[1] for r in repeats]
        text += f", ratio {median(ratios):.3f}"
        if len(ratios) > 2:
            low, _, high = quantiles(ratios, n=4, method="inclusive")
            text += f" ({low:.3f} to {high:.3f})"
    return text


def counted(counts):
    """Instruction counts, in words."""
    text = f"{counts[0]:10.0f} instructions"
    return text + (f", ratio {counts[0] / counts[1]:.4f}" if len(counts) > 1 else "")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    measure.arguments(parser)
    parser.add_argument("--compare", type=Path, metavar="PROGRAM", help="another build, to which ratios are taken")
    parser.add_argument("--integrators", default="bdpt,path")
    parser.add_argument("--repeats", type=int, default=7, help="timed renders of each; 0 for none")
    parser.add_argument("--spp", type=int, default=16, help="samples a pixel of a timed render")
    parser.add_argument("--no-valgrind", action="store_true", help="times alone")
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    binaries = [options.binary] + ([options.compare] if options.compare else [])
    counts = not options.no_valgrind and measure.has_valgrind()
    for name, scene in measure.scenes(options):
        for integrator in options.integrators.split(","):
            parts = [f"{name:9} {integrator:5}"]
            if counts:
                parts.append(counted([instructions(b, scene, integrator, options.work) for b in binaries]))
            parts.append(timed(times(binaries, scene, integrator, options)))
            print("  ".join(parts), flush=True)


if __name__ == "__main__":
    main()
