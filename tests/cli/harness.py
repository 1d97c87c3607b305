"""Runs the wavecrest binary for the tests of its command line, and reads what it leaves behind.

The binary's path comes in the environment variable WAVECREST. Only the standard library is used: an EXR header and a PFM
are simple enough to be read here, by code that shares nothing with the code under test.
"""

import json
import os
import pathlib
import re
import resource
import struct
import subprocess
import tempfile
import time
import unittest

WAVECREST = os.environ["WAVECREST"]
# Variables of whoever runs the tests would change what is rendered: WAVECREST_SIZE, WAVECREST_SCENES and their like.
for _name in [name for name in os.environ if name.startswith("WAVECREST_")]:
    del os.environ[_name]
TIMEOUT_SECONDS = 300

DONE, FAILURE, USAGE, INPUT, CHECK, INTERRUPTED = 0, 1, 2, 3, 4, 130


class CommandTest(unittest.TestCase):
    """A test with a folder of its own that runs wavecrest in it."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="wavecrest_cli_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def path(self, name):
        return str(self.folder / name)

    def write(self, name, content):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return str(path)

    def run_wavecrest(self, *arguments, expect=DONE, variables=None):
        """Runs to the end and checks the exit code, unless that is None; returns the completed process with its text."""
        result = subprocess.run(
            [WAVECREST, *map(str, arguments)],
            cwd=self.folder,
            capture_output=True,
            text=True,
            timeout=TIMEOUT_SECONDS,
            check=False,
            env=os.environ | (variables or {}),
        )
        self.assertEqual(result.returncode, result.returncode if expect is None else expect, f"{arguments}\n{result.stdout}\n{result.stderr}")
        return result

    def start(self, *arguments, stdin=None, limits=None, variables=None):
        """Begins to run, with limits as {resource.RLIMIT_...: (soft, hard)}; the process is killed at the end of the test."""

        def limit():
            for kind, values in (limits or {}).items():
                resource.setrlimit(kind, values)

        process = subprocess.Popen(
            [WAVECREST, *map(str, arguments)], cwd=self.folder, stdin=stdin, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, text=True, preexec_fn=limit,
            env=os.environ | (variables or {}),
        )  # fmt: skip
        self.addCleanup(process.kill)
        return process

    def end(self, process, expect):
        """Waits for what start has begun and checks the exit code; returns what it has written."""
        output, error = process.communicate(timeout=TIMEOUT_SECONDS)
        self.assertEqual(process.returncode, expect, error)
        return output, error

    def wait_for(self, condition):
        deadline = time.monotonic() + TIMEOUT_SECONDS
        while not condition():
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.01)

    def render(self, *arguments, scene="cornell-diffuse", expect=DONE):
        return self.run_wavecrest("render", scene, "--size", "32x24", "--threads", "2", *arguments, expect=expect)

    def assert_one_error_line(self, result, pattern):
        """One line on stderr: `wavecrest: error: ` and what the pattern asks for."""
        lines = [line for line in result.stderr.splitlines() if line]
        self.assertEqual(len(lines), 1, result.stderr)
        self.assertRegex(lines[0], r"^wavecrest: error: " + pattern)


def read_json(path):
    return json.loads(pathlib.Path(path).read_text())


def read_exr_header(path):
    """The attributes of a single-part EXR: text as str, the data window as (x0, y0, x1, y1), others as bytes."""
    data = pathlib.Path(path).read_bytes()
    magic, version = struct.unpack_from("<II", data)
    if magic != 20000630 or version & 0xFF != 2:
        raise ValueError(f"{path}: no EXR file")
    attributes = {}
    at = 8

    def take_text():
        nonlocal at
        end = data.index(b"\0", at)
        text = data[at:end].decode()
        at = end + 1
        return text

    while data[at] != 0:
        name, kind = take_text(), take_text()
        (size,) = struct.unpack_from("<i", data, at)
        value = data[at + 4 : at + 4 + size]
        at += 4 + size
        if kind == "string":
            value = value.decode()
        elif kind == "box2i":
            value = struct.unpack("<4i", value)
        attributes[name] = value
    return attributes


def read_pfm(path):
    """(width, height, floats) of a little-endian colour PFM, bottom row first as stored."""
    match = re.match(rb"PF\s+(\d+)\s+(\d+)\s+(-[\d.]+)\s", data := pathlib.Path(path).read_bytes())
    if match is None:
        raise ValueError(f"{path}: no little-endian colour PFM")
    width, height = int(match[1]), int(match[2])
    return width, height, struct.unpack_from(f"<{3 * width * height}f", data, match.end())


def png_size(path):
    data = pathlib.Path(path).read_bytes()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError(f"{path}: no PNG file")
    return struct.unpack_from(">II", data, 16)
