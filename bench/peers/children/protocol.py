"""How a program is kept loaded between renders: a child process that answers one JSON line per render.

The parent writes {"seed": n, "image": "file.npy"}; the child renders, saves the linear RGB image and answers
{"paths", "cpu_seconds", "wall_seconds"}. CPU time is that of the whole child process, all threads, during the render
alone: loading, kernel compilation and saving fall outside. Renders with `seed` outside the measured ones warm it up.
"""

import json
import os
import resource
import sys
import time

import numpy as np

WARM_UP_SEED = 987654321

# Libraries print to standard output as they please, some while they are imported: import this module first. Answers go
# to a private copy of it.
ANSWERS = os.fdopen(os.dup(sys.stdout.fileno()), "w")
os.dup2(sys.stderr.fileno(), sys.stdout.fileno())


def answer(message):
    print(json.dumps(message), file=ANSWERS, flush=True)


def cpu_seconds():
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def serve(about, paths, render):
    """Answers requests until stdin ends. render(seed) -> image (height, width, 3), complete when it returns."""
    render(WARM_UP_SEED)
    answer({"about": about})
    for line in sys.stdin:
        request = json.loads(line)
        wall, cpu = time.perf_counter(), cpu_seconds()
        image = render(request["seed"])
        wall, cpu = time.perf_counter() - wall, cpu_seconds() - cpu
        np.save(request["image"], np.asarray(image, dtype=np.float32)[..., :3])
        answer({"paths": paths, "cpu_seconds": cpu, "wall_seconds": wall})
