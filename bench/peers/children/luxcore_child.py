"""Child process that renders with LuxCore: luxcore_child.py JOB (a JSON object, see programs.py)."""

import json
import sys
import time

import protocol  # first: it takes standard output

import numpy as np
import pyluxcore

import luxcore_scene

ENGINES = {"pt": "PATHCPU", "bpt": "BIDIRCPU", "vcm": "BIDIRVMCPU"}
POLL_SECONDS = 0.002


def engine_settings(job):
    """Independent samples, no filter, halt after spp samples of every pixel."""
    depth = job["max_depth"] if job["max_depth"] >= 0 else 64
    return {
        "renderengine.type": ENGINES[job["method"]],
        "native.threads.count": job["threads"] or 0,
        "sampler.type": "RANDOM",
        "film.width": job["size"][0],
        "film.height": job["size"][1],
        "film.filter.type": "NONE",
        "film.outputs.0.type": "RGB",
        "film.outputs.0.filename": "unused.exr",
        "path.pathdepth.total": depth,
        "path.pathdepth.diffuse": depth,
        "path.pathdepth.glossy": depth,
        "path.pathdepth.specular": depth,
        "path.russianroulette.depth": job["rr_depth"],
        "light.russianroulette.depth": job["rr_depth"],
        "light.maxdepth": depth,
        "path.clamping.variance.maxvalue": 0,
        "batch.haltspp": job["spp"],
    }


def properties(settings):
    result = pyluxcore.Properties()
    for name, value in settings.items():
        result.Set(pyluxcore.Property(name, value))
    return result


def main():
    job = json.loads(sys.argv[1])
    pyluxcore.Init(lambda message: None)
    scene = pyluxcore.Scene()
    scene.Parse(properties(luxcore_scene.convert(job["scene"], job["size"])))
    width, height = job["size"]

    def render(seed):
        settings = {**engine_settings(job), "renderengine.seed": seed % 100000 + 1}
        session = pyluxcore.RenderSession(pyluxcore.RenderConfig(properties(settings), scene))
        session.Start()
        while not session.HasDone():
            time.sleep(POLL_SECONDS)
            session.UpdateStats()
        session.Stop()
        pixels = np.zeros((height, width, 3), dtype=np.float32)
        session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB, pixels, 0, False)
        return np.flipud(pixels)

    protocol.serve(f"LuxCore {pyluxcore.Version()} {ENGINES[job['method']]}", width * height * job["spp"], render)


if __name__ == "__main__":
    main()
