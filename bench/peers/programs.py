"""The programs that are compared, behind one face: start, render(seed) -> Sample, stop. One list, PROGRAMS."""

import dataclasses
import json
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import time

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent


@dataclasses.dataclass
class Job:
    """What every program is asked to do."""

    scene: str  # flat XML file with size and box filter in it
    method: str
    size: tuple
    spp: int
    threads: int
    max_depth: int
    rr_depth: int


@dataclasses.dataclass
class Sample:
    """One render. image is None where a program's scene is not ours."""

    paths: int
    cpu_seconds: float
    wall_seconds: float
    image: np.ndarray | None


class Child:
    """A Python child process that keeps scene and compiled kernels between renders (children/protocol.py)."""

    def __init__(self, script, job, **extra):
        arguments = json.dumps({**dataclasses.asdict(job), **extra})
        command = [sys.executable, str(HERE / "children" / script), arguments]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.about = self._receive()["about"]

    def _receive(self):
        line = self.process.stdout.readline()
        if not line:
            raise RuntimeError(f"{self.process.args[1]} ended with status {self.process.wait()}")
        return json.loads(line)

    def render(self, seed):
        with tempfile.TemporaryDirectory() as folder:
            image = os.path.join(folder, "image.npy")
            print(json.dumps({"seed": seed, "image": image}), file=self.process.stdin, flush=True)
            answer = self._receive()
            return Sample(**answer, image=np.load(image))

    def stop(self):
        self.process.stdin.close()
        self.process.wait()


class Wavecrest:
    """A process per render. Its own statistics leave out loading and building, as for the others."""

    def __init__(self, program, job, options=()):
        self.program, self.job, self.options = program, job, options
        self.about = "wavecrest"
        self.render(0)  # files and libraries into memory

    def render(self, seed):
        job = self.job
        with tempfile.TemporaryDirectory() as folder:
            image, stats = os.path.join(folder, "image.pfm"), os.path.join(folder, "stats.json")
            command = [self.program, "render", job.scene, "--method", job.method, "--spp", job.spp, "--seed", seed]
            command += ["--threads", job.threads, "--max-depth", job.max_depth, "--rr-depth", job.rr_depth]
            command += ["--progress", "none", "-o", image, "--stats", stats, *self.options]
            subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL)
            with open(stats, encoding="utf-8") as file:
                told = json.load(file)
            self.about = f"wavecrest {told['version']} {told['isa']} {told['precision']} {told['sampler']}"
            paths = max(told["camera_paths"], told["light_paths"])
            return Sample(paths, told["cpu_seconds"], told["render_seconds"], read_pfm(image))

    def stop(self):
        pass


class SmallVcm:
    """SmallVCM renders its own built-in scene 0 only: paths per second can be compared, images cannot."""

    def __init__(self, program, job):
        self.program, self.job = os.path.abspath(program), job
        self.about = "SmallVCM, its scene 0"
        self.render(0)

    def render(self, seed):
        del seed  # it has none on its command line
        with tempfile.TemporaryDirectory() as folder:
            output = os.path.join(folder, "image.bmp")
            command = [self.program, "-s", "0", "-a", self.job.method, "-i", str(self.job.spp), "-o", output]
            start = time.perf_counter()
            process = subprocess.Popen(command, stdout=subprocess.DEVNULL, preexec_fn=self._limit_threads)
            _, status, usage = os.wait4(process.pid, 0)
            wall = time.perf_counter() - start
            if status != 0:
                raise RuntimeError(f"{self.program} ended with wait status {status}")
            width, height = bmp_size(output)  # set when it was built
        return Sample(width * height * self.job.spp, usage.ru_utime + usage.ru_stime, wall, None)

    def _limit_threads(self):
        """It starts a thread per processor that it may run on."""
        if self.job.threads:
            os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[: self.job.threads])

    def stop(self):
        pass


def bmp_size(path):
    """Width and height from the header of a BMP file."""
    with open(path, "rb") as file:
        width, height = struct.unpack_from("<ii", file.read(26), 18)
        return width, abs(height)


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
        ("pt", "lt", "bpt", "mlt", "ppm", "bpm", "vcm"),
        lambda job, options: Wavecrest(options.wavecrest, job, options.wavecrest_options.split()),
    ),
    "mitsuba-llvm": (("pt", "lt"), lambda job, options: Child("mitsuba_child.py", job, variant="llvm_ad_rgb")),
    "mitsuba-scalar": (("pt", "lt"), lambda job, options: Child("mitsuba_child.py", job, variant="scalar_rgb")),
    "luxcore": (("pt", "bpt", "vcm"), lambda job, options: Child("luxcore_child.py", job)),
    "smallvcm": (("pt", "lt", "bpt", "ppm", "bpm", "vcm"), lambda job, options: SmallVcm(options.smallvcm, job)),
}
