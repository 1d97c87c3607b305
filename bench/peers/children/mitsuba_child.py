"""Child process that renders with Mitsuba 3: mitsuba_child.py JOB (a JSON object, see programs.py)."""

import json
import pathlib
import sys

import protocol  # first: it takes standard output

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "tools"))

from mitsuba_support import variant  # noqa: E402

INTEGRATORS = {"pt": "path", "lt": "ptracer"}


def main():
    job = json.loads(sys.argv[1])
    mitsuba = variant.start(job["variant"], job["threads"])
    scene = mitsuba.load_file(job["scene"])
    integrator = mitsuba.load_dict(
        {"type": INTEGRATORS[job["method"]], "max_depth": job["max_depth"], "rr_depth": job["rr_depth"]}
    )

    def render(seed):
        # np.array waits for the result: Dr.Jit evaluates lazily.
        return np.array(mitsuba.render(scene, integrator=integrator, spp=job["spp"], seed=seed))

    width, height = job["size"]
    protocol.serve(f"Mitsuba {mitsuba.__version__} {job['variant']}", width * height * job["spp"], render)


if __name__ == "__main__":
    main()
