"""A program that stays loaded between renders, as a child process that speaks children/protocol.py."""

import dataclasses
import functools
import json
import pathlib
import re
import select
import subprocess
import sys
import tempfile

import numpy as np

from job import Failed, Sample

HERE = pathlib.Path(__file__).resolve().parent
CHILDREN = HERE / "children"
LIMIT_SECONDS = 120  # for loading with a first render, and for any other render


class Child:
    """One program with one scene. spp may be changed between renders. Raises Failed with a reason of one line."""

    def __init__(self, script, job, python=sys.executable, neutral=False, **extra):
        if neutral:
            extra["neutral"] = neutral_folder(job.scene)
        self.spp = job.spp
        self.errors = tempfile.TemporaryFile("w+")
        command = [python, str(CHILDREN / script), json.dumps({**dataclasses.asdict(job), **extra})]
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": self.errors}
        self.process = subprocess.Popen(command, text=True, **pipes)
        try:
            first = self._receive()
            if "refused" in first:
                raise Failed(first["refused"])
        except BaseException:
            self.stop()
            raise
        self.about = first["about"]

    def _receive(self):
        ready, _, _ = select.select([self.process.stdout], [], [], LIMIT_SECONDS)
        if not ready:
            self.process.kill()
            raise Failed(f"takes more than {LIMIT_SECONDS} s")
        line = self.process.stdout.readline()
        if not line:
            raise Failed(self._last_words(self.process.wait()))
        return json.loads(line)

    def _last_words(self, status):
        self.errors.seek(0)
        lines = [line.strip() for line in self.errors.read().splitlines() if line.strip()]
        # The first exception: what follows it was caused by it.
        thrown = [found[1] for line in lines if (found := re.match(r"\w*(?:Error|Exception): (.*)", line))]
        return (thrown or lines[-1:] or [f"ended with status {status}"])[0]

    def render(self, seed):
        with tempfile.TemporaryDirectory() as folder:
            image = str(pathlib.Path(folder) / "image.npy")
            request = json.dumps({"seed": seed, "spp": self.spp, "image": image})
            try:
                print(request, file=self.process.stdin, flush=True)
            except BrokenPipeError:
                raise Failed(self._last_words(self.process.wait())) from None
            answer = self._receive()
            return Sample(**answer, image=np.load(image))

    def stop(self):
        try:
            self.process.stdin.close()
        except BrokenPipeError:
            pass
        try:
            self.process.wait(30)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.process.stdout.close()
        self.errors.close()


@functools.cache
def neutral_folder(scene):
    """Folder beside a flat scene file with what children/neutral_convert.py made of it. Raises Failed."""
    folder = pathlib.Path(f"{scene}.neutral")
    folder.mkdir(exist_ok=True)
    command = [sys.executable, str(CHILDREN / "neutral_convert.py"), str(scene), str(folder)]
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise Failed((done.stderr.strip().splitlines() or [f"the converter ended with status {done.returncode}"])[-1])
    return str(folder)


@functools.cache
def cycles_python():
    """The interpreter that has bpy. Raises Failed."""
    done = subprocess.run([str(HERE / "cycles-python")], stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise Failed("bpy could not be installed (bench/peers/cycles-python)")
    return done.stdout.strip().splitlines()[-1]
