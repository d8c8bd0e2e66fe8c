"""Runs one renderer on one scene for a given time.

Each peer runs in a process of its own (two of them in one process crash each other). Time is time spent rendering:
starting up, loading the scene, building the tree and compiling kernels are left out for all alike.
"""

import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections import namedtuple
from pathlib import Path

import numpy as np

import scenes

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parent.parent

# image: (rows, width, 3), linear; rows may be missing at the bottom. samples: per pixel. variant: how the engine was run.
# cpu: processor time of the whole process over the wall time of all threads; well below 1 on a busy machine.
Render = namedtuple("Render", "image samples seconds variant cpu", defaults=[0.0])

# family: who renders; settings: what its worker is told; rescaled: compared after scaling to the reference's mean.
Engine = namedtuple("Engine", "family settings rescaled", defaults=[False])

ENGINES = {
    "caustica-bdpt": Engine("caustica", {"integrator": "bdpt"}),
    "caustica-path": Engine("caustica", {"integrator": "path"}),
    "caustica-light": Engine("caustica", {"integrator": "light"}),
    "mitsuba-path": Engine("mitsuba", {"integrator": "path"}),
    "mitsuba-path-scalar": Engine("mitsuba", {"integrator": "path", "variant": "scalar_rgb"}),
    "mitsuba-ptracer": Engine("mitsuba", {"integrator": "ptracer"}),
    "luxcore-path": Engine("luxcore", {"engine": "PATHCPU", "hybrid": 0}),
    "luxcore-hybrid": Engine("luxcore", {"engine": "PATHCPU", "hybrid": 1}),
    "luxcore-bidir": Engine("luxcore", {"engine": "BIDIRCPU", "hybrid": 0}, True),
}


class Failed(Exception):
    """A renderer did not deliver an image; the message ends with what it said."""


class Runner:
    """Runs engines with the same number of threads; `caustica` is the program to be measured."""

    def __init__(self, caustica, threads):
        self.caustica, self.threads, self._variant = caustica, threads, None

    def render(self, name, folder, seconds, seed):
        """Renders the scene that was exported into `folder`."""
        engine = ENGINES[name]
        with tempfile.TemporaryDirectory() as scratch:
            run = {"caustica": self._caustica, "mitsuba": self._mitsuba, "luxcore": self._luxcore}[engine.family]
            if engine.family == "mitsuba":
                self.mitsuba_variant(folder)
            wall, before = time.perf_counter(), resource.getrusage(resource.RUSAGE_CHILDREN)
            render = run(engine.settings, Path(folder), seconds, seed, Path(scratch))
            wall, after = time.perf_counter() - wall, resource.getrusage(resource.RUSAGE_CHILDREN)
            used = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
            return render._replace(cpu=used / (wall * self.threads))

    def _caustica(self, settings, folder, seconds, seed, scratch):
        command = [self.caustica, "render", folder / "caustica.xml", "-o", scratch / "image", "--time", f"{seconds}s",
                   "--threads", self.threads, "--max-depth", scenes.MAX_DEPTH, "--seed", seed, "--json",
                   "--integrator", settings["integrator"]]
        said = json.loads(_call(command))
        return Render(read_exr(scratch / "image.exr"), said["samples"], said["seconds"], settings["integrator"])

    def _mitsuba(self, settings, folder, seconds, seed, scratch):
        variant = settings.get("variant") or self.mitsuba_variant(folder)
        job = {"scene": str(folder / "mitsuba.xml"), "variant": variant, "integrator": settings["integrator"]}
        return self._worker("mitsuba_worker.py", job, seconds, seed, scratch, variant)

    def _luxcore(self, settings, folder, seconds, seed, scratch):
        job = {"scene": str(folder / "luxcore.scn"), "width": scenes.WIDTH, "height": scenes.HEIGHT,
               "depth": scenes.MAX_DEPTH, **settings}
        found = self._worker("luxcore_worker.py", job, seconds, seed + 1, scratch, settings["engine"])
        # The image sits one row low: its second row is the picture's first, and the picture's last is missing.
        return found._replace(image=found.image[1:])

    def _worker(self, script, job, seconds, seed, scratch, variant):
        output = scratch / "image.npz"
        job = {**job, "seconds": seconds, "seed": seed, "threads": self.threads, "output": str(output)}
        _call([sys.executable, HERE / script, json.dumps(job)], environment=_with_llvm(), done=output)
        with np.load(output) as found:
            return Render(found["image"].astype(np.float32), float(found["samples"]), float(found["seconds"]), variant)

    def mitsuba_variant(self, folder):
        """The fastest variant that works here, found by a second of rendering with each."""
        if self._variant is None:
            speeds = {}
            for variant in ("scalar_rgb", "llvm_ad_rgb"):
                try:
                    with tempfile.TemporaryDirectory() as scratch:
                        tried = self._mitsuba({"integrator": "path", "variant": variant}, folder, 1, 0, Path(scratch))
                    speeds[variant] = tried.samples / tried.seconds
                except Failed as failure:
                    print(f"Mitsuba's {variant} does not work here: {str(failure).splitlines()[-1]}")
            if not speeds:
                raise Failed("no variant of Mitsuba works here")
            self._variant = max(speeds, key=speeds.get)
            print("Mitsuba: " + ", ".join(f"{v} {s * scenes.WIDTH * scenes.HEIGHT / 1e6:.2f} million samples/s"
                                          for v, s in speeds.items()) + f"; taking {self._variant}")
        return self._variant


def _with_llvm():
    """The environment for Mitsuba; an LLVM that lies in the scratch environment's `llvm` folder is used."""
    environment = dict(os.environ)
    libraries = sorted(Path(sys.prefix, "llvm").rglob("libLLVM*.so*"))
    if libraries:
        environment.setdefault("DRJIT_LIBLLVM_PATH", str(libraries[-1]))
    return environment


def _call(command, environment=None, done=None):
    """Runs a command and returns its standard output.

    A peer may crash while it exits; that does not matter once the file `done` is there.
    """
    command = [str(word) for word in command]
    ended = subprocess.run(command, env=environment, text=True, errors="replace", capture_output=True)
    if ended.returncode and not (done and done.exists()):
        raise Failed(f"{' '.join(command[:2])} failed ({ended.returncode}):\n{(ended.stdout + ended.stderr)[-2000:]}")
    return ended.stdout


def _bitmap(*arguments):
    import mitsuba  # only here: the script starts without the peers
    if mitsuba.variant() is None:
        mitsuba.set_variant("scalar_rgb")
    return mitsuba.Bitmap(*arguments)


def read_exr(path):
    """The first three channels of an EXR file: Caustica's `combined` layer."""
    return np.array(_bitmap(str(path)))[:, :, :3].astype(np.float32)


def write_png(image, path):
    """A preview: clipped, with sRGB's curve."""
    clipped = np.clip(np.nan_to_num(image), 0, 1)
    curve = np.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * clipped ** (1 / 2.4) - 0.055)
    _bitmap((255 * curve + 0.5).astype(np.uint8)).write(str(path))


def find_caustica(given):
    """The program to measure: the one given, else the release build of this repository."""
    target = Path(os.environ.get("CARGO_TARGET_DIR") or REPOSITORY / "target")
    path = Path(given) if given else target / "release" / "caustica"
    if not path.is_file():
        sys.exit(f"{path} is not there: build it with `cargo build --release`, or name it with --caustica")
    return path.resolve()
