"""How a program is kept loaded between renders: a child process that answers one JSON line per render.

The parent writes {"seed": n, "spp": m, "image": "file.npy"}; the child renders, saves the linear RGB image and answers
{"paths", "cpu_seconds", "wall_seconds"}. CPU time is that of the whole child process, all threads, during the render
alone: loading, kernel compilation and saving fall outside. Renders with `seed` outside the measured ones warm it up.
A child that cannot take the scene answers {"refused": reason} instead of its first line.
"""

import contextlib
import dataclasses
import json
import os
import resource
import sys
import time
import typing

import numpy as np

WARM_UP_SEED = 987654321

# Libraries print to standard output as they please, some while they are imported: import this module first. Answers go
# to a private copy of it.
ANSWERS = os.fdopen(os.dup(sys.stdout.fileno()), "w")
os.dup2(sys.stderr.fileno(), sys.stdout.fileno())


@dataclasses.dataclass
class Rendered:
    """What a render leaves. Only the render is timed, not the fetching of its image."""

    fetch: typing.Callable  # () -> image (height, width, 3)
    paths: int | None = None  # None: pixels times samples
    cpu_seconds: float | None = None  # None: as protocol measures them


def answer(message):
    print(json.dumps(message), file=ANSWERS, flush=True)


@contextlib.contextmanager
def refusals(kind):
    """Tells the parent of an exception of this kind, and ends the process."""
    try:
        yield
    except kind as reason:
        answer({"refused": str(reason)})
        sys.exit(0)


def keep_to_processors(count):
    """Of those that the process may run on, the last ones; 0 leaves them all."""
    if count:
        os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[-count:])


def cpu_seconds():
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def serve(about, job, render):
    """Answers requests until stdin ends. render(seed, spp) -> Rendered, complete when it returns.

    The warm-up has the job's number of samples, as Mitsuba compiles for it, and compiles again for the second render.
    """
    for offset in range(2):
        render(WARM_UP_SEED + offset, job["spp"]).fetch()
    answer({"about": about})
    pixels = job["size"][0] * job["size"][1]
    for line in sys.stdin:
        request = json.loads(line)
        wall, cpu = time.perf_counter(), cpu_seconds()
        rendered = render(request["seed"], request["spp"])
        wall, cpu = time.perf_counter() - wall, cpu_seconds() - cpu
        np.save(request["image"], np.asarray(rendered.fetch(), dtype=np.float32)[..., :3])
        paths = pixels * request["spp"] if rendered.paths is None else rendered.paths
        cpu = cpu if rendered.cpu_seconds is None else rendered.cpu_seconds
        answer({"paths": paths, "cpu_seconds": cpu, "wall_seconds": wall})
