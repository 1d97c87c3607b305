"""Child process that renders with LuxCore: luxcore_child.py JOB (a JSON object, see programs.py)."""

import json
import sys
import time

import protocol  # first: it takes standard output

import numpy as np
import pyluxcore

import luxcore_scene
import neutral_scene

ENGINES = {"pt": "PATHCPU", "bpt": "BIDIRCPU", "vcm": "BIDIRVMCPU"}
POLL_SECONDS = 0.002


def engine_settings(job, spp):
    """Independent samples, no filter, halt after spp samples of every pixel."""
    depth = job["max_depth"] if job["max_depth"] >= 0 else 64
    return {
        "renderengine.type": ENGINES[job["method"]],
        "native.threads.count": job["threads"] or 0,
        "sampler.type": "RANDOM",
        # With buckets of more pixels BIDIRVMCPU leaves most pixels without what it merges.
        "sampler.random.bucketsize": 1,
        # As many as pixels, as for wavecrest; the default of 16384 would render small films more often than asked.
        "bidirvm.lightpath.count": job["size"][0] * job["size"][1],
        # The first merge radius, relative to the bounding sphere, and how slowly it shrinks: as wavecrest has them.
        "bidirvm.startradius.scale": 0.001,
        "bidirvm.alpha": 0.75,
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
        "batch.haltspp": spp,
    }


def properties(settings):
    result = pyluxcore.Properties()
    for name, value in settings.items():
        result.Set(pyluxcore.Property(name, value))
    return result


def samples_of(session):
    return session.GetStats().Get("stats.renderengine.total.samplecount").GetInt()


class SteadyClock:
    """CPU seconds of a render as if all of it had gone as fast as after its first samples.

    Within the first iteration BIDIRVMCPU makes a sampler for each light path, which takes as long as two iterations: a
    matter of loading, which short renders must not be charged for.
    """

    def __init__(self, first):
        self.first, self.start = first, (0, protocol.cpu_seconds()) if first == 0 else None

    def note(self, samples):
        if self.start is None and samples >= self.first:
            self.start = samples, protocol.cpu_seconds()

    def cpu_seconds(self, samples):
        if self.start is None or samples == self.start[0]:
            raise RuntimeError("the render ended within its first iteration")
        return (protocol.cpu_seconds() - self.start[1]) * samples / (samples - self.start[0])


def main():
    job = json.loads(sys.argv[1])
    pyluxcore.Init(lambda message: None)
    scene = pyluxcore.Scene()
    with protocol.refusals(neutral_scene.Unsupported):
        scene.Parse(properties(luxcore_scene.convert(neutral_scene.load(job["neutral"]))))
    width, height = job["size"]

    def pixels_of(session):
        pixels = np.zeros((height, width, 3), dtype=np.float32)
        session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB, pixels, 0, False)
        return np.flipud(pixels)

    def render(seed, spp):
        settings = {**engine_settings(job, spp), "renderengine.seed": seed % 100000 + 1}
        session = pyluxcore.RenderSession(pyluxcore.RenderConfig(properties(settings), scene))
        clock = SteadyClock(width * height if job["method"] == "vcm" else 0)
        session.Start()
        while not session.HasDone():
            time.sleep(POLL_SECONDS)
            session.UpdateStats()
            clock.note(samples_of(session))
        session.UpdateStats()
        paths = samples_of(session)  # it always renders a little more than it was asked
        seconds = clock.cpu_seconds(paths)
        session.Stop()
        return protocol.Rendered(lambda: pixels_of(session), paths, seconds)

    protocol.serve(f"LuxCore {pyluxcore.Version()} {ENGINES[job['method']]}", job, render)


if __name__ == "__main__":
    main()
