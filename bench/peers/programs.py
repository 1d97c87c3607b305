"""The programs that are compared, behind one face: start, render(seed) -> Sample, stop. One list, PROGRAMS."""

import json
import os
import pathlib
import re
import subprocess
import tempfile
import time

import numpy as np

from child import Child, cycles_python
from job import Failed, Sample


class Wavecrest:
    """A process per render. Its own statistics leave out loading and building, as for the others."""

    def __init__(self, program, job, options=()):
        # SmallVCM merges at every vertex.
        own = ["--merge-vertices", "all"] if job.method == "vcm" and "--merge-vertices" not in options else []
        if "--sampler" not in options:
            own += ["--sampler", "independent"]
        # LuxCore begins with this radius; by default ours is chosen from the scene.
        if job.method in ("ppm", "bpm", "vcm") and "--radius" not in options:
            own += ["--radius", "0.001"]
        self.program, self.job, self.options = program, job, [*own, *options]
        self.about = "wavecrest"
        self.spp = job.spp
        self.render(0)  # files and libraries into memory

    def render(self, seed):
        job = self.job
        with tempfile.TemporaryDirectory() as folder:
            image, stats = os.path.join(folder, "image.pfm"), os.path.join(folder, "stats.json")
            command = [self.program, "render", job.scene, "--method", job.method, "--spp", self.spp, "--seed", seed]
            command += ["--threads", job.threads] if job.threads else []  # without: its default
            command += ["--max-depth", job.max_depth, "--rr-depth", job.rr_depth]
            command += ["--progress", "none", "-o", image, "--stats", stats, *self.options]
            words = [str(word) for word in command]
            try:
                done = subprocess.run(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            except OSError as error:
                raise Failed(f"{self.program}: {error.strerror}") from None
            if done.returncode != 0:
                raise Failed((done.stderr.strip().splitlines() or [f"status {done.returncode}"])[-1])
            with open(stats, encoding="utf-8") as file:
                told = json.load(file)
            self.about = f"wavecrest {told['version']} {told['isa']} {told['precision']} {told['sampler']}"
            paths = max(told["camera_paths"], told["light_paths"])
            return Sample(paths, told["cpu_seconds"], told["render_seconds"], read_pfm(image))

    def stop(self):
        pass


class SmallVcm:
    """SmallVCM renders its own four scenes, of which scenes/validation/smallvcm-N-*.xml are copies.

    A job with such a file gets that scene, so images can be compared; any other job scene 0, whose speed alone can.
    Whatever the job says, it renders SIZE up to DEPTH edges, roulette begins at the first vertex and its generator has
    one seed, so there is no variance between rounds of one thread. Its first merge radius is 0.003 of the bounding
    sphere.
    """

    SIZE, DEPTH, RR_DEPTH = (512, 512), 10, 1

    def __init__(self, program, job):
        self.program, self.job = os.path.abspath(program), job
        named = re.match(r"smallvcm-(\d)", pathlib.Path(job.scene).name)
        self.scene, self.comparable = (named[1], True) if named else ("0", False)
        if self.comparable and (job.size, job.max_depth, job.rr_depth) != (self.SIZE, self.DEPTH, self.RR_DEPTH):
            raise Failed("SmallVCM's scenes need --size 512x512 --max-depth 10 --rr-depth 1 to be the same work")
        self.about = f"SmallVCM, its scene {self.scene}"
        self.render(0)

    def render(self, seed):
        del seed
        with tempfile.TemporaryDirectory() as folder:
            output = os.path.join(folder, "image.hdr")
            command = [self.program, "-s", self.scene, "-a", self.job.method, "-i", str(self.job.spp), "-o", output]
            start = time.perf_counter()
            try:
                process = subprocess.Popen(command, stdout=subprocess.DEVNULL, preexec_fn=self._limit_threads)
            except OSError as error:
                raise Failed(f"{self.program}: {error.strerror}") from None
            _, status, usage = os.wait4(process.pid, 0)
            wall = time.perf_counter() - start
            if status != 0:
                raise Failed(f"{self.program} ended with wait status {status}")
            image = read_rgbe(output)
        paths = image.shape[0] * image.shape[1] * self.job.spp
        return Sample(paths, usage.ru_utime + usage.ru_stime, wall, image if self.comparable else None, seeded=False)

    def _limit_threads(self):
        """It starts a thread per processor that it may run on."""
        if self.job.threads:
            os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[: self.job.threads])

    def stop(self):
        pass


def read_rgbe(path):
    """A Radiance picture of flat pixels, top row first, as (height, width, 3); within 1 %, as the format is."""
    with open(path, "rb") as file:
        header, _, rest = file.read().partition(b"\n\n")
    size, _, pixels = rest.partition(b"\n")
    told = re.fullmatch(rb"-Y (\d+) \+X (\d+) *", size)
    if not header.startswith(b"#?RADIANCE") or not told or len(pixels) != 4 * int(told[1]) * int(told[2]):
        raise ValueError(f"{path}: expected a Radiance picture of flat pixels")
    rgbe = np.frombuffer(pixels, np.uint8).reshape(int(told[1]), int(told[2]), 4)
    scale = np.where(rgbe[..., 3:] == 0, 0, np.ldexp(1.0, rgbe[..., 3:].astype(int) - 136))
    return ((rgbe[..., :3] + 0.5) * scale).astype(np.float32)


def read_pfm(path):
    """A colour PFM file as (height, width, 3), first row on top."""
    with open(path, "rb") as file:
        kind = file.readline().strip()
        width, height = (int(word) for word in re.findall(rb"\d+", file.readline()))
        order = "<f4" if float(file.readline()) < 0 else ">f4"
        if kind != b"PF":
            raise ValueError(f"{path}: PFM of kind {kind!r}; expected PF (three channels)")
        return np.flipud(np.frombuffer(file.read(), order).reshape(height, width, 3)).astype(np.float32)


# name -> (methods it has, how to start it for a job given the command line's options)
PROGRAMS = {
    "wavecrest": (
        ("pt", "lt", "bpt", "mlt", "ppm", "bpm", "vcm", "gpt"),
        lambda job, options: Wavecrest(options.wavecrest, job, options.wavecrest_options.split()),
    ),
    "mitsuba-llvm": (("pt", "lt"), lambda job, options: Child("mitsuba_child.py", job, variant="llvm_ad_rgb")),
    "mitsuba-scalar": (("pt", "lt"), lambda job, options: Child("mitsuba_child.py", job, variant="scalar_rgb")),
    "luxcore": (("pt", "bpt", "vcm"), lambda job, options: Child("luxcore_child.py", job, neutral=True)),
    "cycles": (("pt",), lambda job, options: Child("cycles_child.py", job, python=cycles_python(), neutral=True)),
    "smallvcm": (("pt", "lt", "bpt", "ppm", "bpm", "vcm"), lambda job, options: SmallVcm(options.smallvcm, job)),
}
