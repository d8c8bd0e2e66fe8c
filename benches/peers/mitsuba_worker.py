"""Renders with Mitsuba 3 in a process of its own. Arguments: one JSON object; see `peers.py`.

Passes of a few samples, each with a seed of its own, are rendered until the time is over, and averaged. Loading, building
the tree and compiling kernels (one pass that is thrown away) come before the clock starts.
"""

import json
import sys
import time

import drjit as dr
import mitsuba as mi
import numpy as np

SAMPLES_A_PASS = 4


def main(job):
    mi.set_variant(job["variant"])
    dr.set_thread_count(job["threads"])
    scene = mi.load_file(job["scene"], integrator=job["integrator"])

    def one_pass(seed):
        return np.array(mi.render(scene, spp=SAMPLES_A_PASS, seed=seed), np.float64)

    total = np.zeros_like(one_pass(0xffff))
    passes, start = 0, time.perf_counter()
    while time.perf_counter() - start < job["seconds"]:
        passes += 1
        total += one_pass(job["seed"] * 100_000 + passes)
    seconds = time.perf_counter() - start
    np.savez(job["output"], image=total / passes, samples=passes * SAMPLES_A_PASS, seconds=seconds)


if __name__ == "__main__":
    main(json.loads(sys.argv[1]))
