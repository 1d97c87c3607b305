"""Child process that renders with Mitsuba 3: mitsuba_child.py JOB (a JSON object, see programs.py)."""

import json
import pathlib
import sys

import protocol  # first: it takes standard output

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "tools"))

from mitsuba_support import scene_xml, variant  # noqa: E402

INTEGRATORS = {"pt": "path", "lt": "ptracer"}


def main():
    job = json.loads(sys.argv[1])
    mitsuba = variant.start(job["variant"])
    scene = mitsuba.load_file(job["scene"])
    variant.set_threads(job["threads"])  # now: with one thread Mitsuba 3.9 never comes back from loading an EXR file
    words = {"type": INTEGRATORS[job["method"]], "max_depth": job["max_depth"], "rr_depth": job["rr_depth"]}
    words["hide_emitters"] = scene_xml.hides_emitters(pathlib.Path(job["scene"]).read_text(encoding="utf-8"))
    integrator = mitsuba.load_dict(words)

    def render(seed, spp):
        # np.array waits for the result: Dr.Jit evaluates lazily.
        image = np.array(mitsuba.render(scene, integrator=integrator, spp=spp, seed=seed))
        return protocol.Rendered(lambda: image, image.shape[0] * image.shape[1] * spp)  # of a crop window, its own

    protocol.serve(f"Mitsuba {mitsuba.__version__} {job['variant']}", job, render)


if __name__ == "__main__":
    main()
