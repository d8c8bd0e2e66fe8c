"""Renders with LuxCore in a process of its own. Arguments: one JSON object; see `peers.py`.

The clock starts when the render threads have been started, after the scene has been read and its tree built. The hybrid
engine's light paths are sampled by Metropolis, which first estimates a normalisation; the clock starts after that, too.
"""

import json
import sys
import time

import numpy as np
import pyluxcore

CONFIG = """
renderengine.type = {engine}
renderengine.seed = {seed}
native.threads.count = {threads}
film.width = {width}
film.height = {height}
film.filter.type = NONE
film.imagepipeline.0.type = NOP
film.outputs.0.type = RGB
film.outputs.0.filename = unused.exr
sampler.type = SOBOL
sampler.sobol.adaptive.strength = 0
sampler.sobol.bucketsize = 256
path.maxdepth = {depth}
path.pathdepth.total = {depth}
path.pathdepth.diffuse = {depth}
path.pathdepth.glossy = {depth}
path.pathdepth.specular = {depth}
light.maxdepth = {depth}
path.clamping.variance.maxvalue = 0
path.hybridbackforward.enable = {hybrid}
path.hybridbackforward.partition = 0.8
"""


def main(job):
    prepared = [0.0]

    def log(message):
        if "luminance estimation" in message:
            prepared[0] = time.perf_counter()

    pyluxcore.Init(log)
    scene = pyluxcore.Scene()
    scene.Parse(pyluxcore.Properties(job["scene"]))
    config = pyluxcore.Properties()
    config.SetFromString(CONFIG.format(**job))
    session = pyluxcore.RenderSession(pyluxcore.RenderConfig(config, scene))
    session.Start()
    start = time.perf_counter()
    while time.perf_counter() - max(start, prepared[0]) < job["seconds"]:
        time.sleep(0.02)
    session.Pause()
    seconds = time.perf_counter() - max(start, prepared[0])
    session.UpdateStats()
    samples = session.GetStats().Get("stats.renderengine.total.samplecount").GetFloat()
    image = np.zeros((job["height"], job["width"], 3), np.float32)
    session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB, image)
    # LuxCore's rows run upwards.
    np.savez(job["output"], image=image[::-1], samples=samples / (job["width"] * job["height"]), seconds=seconds)
    session.Stop()


if __name__ == "__main__":
    main(json.loads(sys.argv[1]))
