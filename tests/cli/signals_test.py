"""Signals: INT, TERM and HUP save and end with 130, USR1 saves and goes on, none of them spoils a write."""

import json
import os
import pathlib
import re
import resource
import signal
import subprocess
import time
import unittest

from harness import DONE, INTERRUPTED, TIMEOUT_SECONDS, CommandTest, read_exr_header, read_json

ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
SMALL = ["cornell-diffuse", "--size", "32x24", "--threads", "1"]


class Signals(CommandTest):
    def started(self, *arguments, scene=SMALL, limit="10m"):
        """A render, of ten minutes unless told otherwise, once paths are traced."""
        process = self.start("render", *scene, "--time", limit, "--progress", "jsonl", *arguments)
        for line in process.stderr:
            if '"paths":' in line and not line.rstrip().endswith('"paths":0}'):
                break
        return process

    def save(self, process, name):
        """Asks for saves until the file is there: before the first whole pass over the film nothing is saved."""
        deadline = time.monotonic() + TIMEOUT_SECONDS
        while not (self.folder / name).exists():
            self.assertLess(time.monotonic(), deadline)
            process.send_signal(signal.SIGUSR1)
            time.sleep(0.1)


class Render(Signals):
    def test_each_ending_signal_saves_what_there_is(self):
        for number in ENDING:
            with self.subTest(signal=number.name):
                name = number.name
                process = self.started("-o", f"{name}.exr", "--stats", f"{name}.json")
                process.send_signal(number)
                self.end(process, INTERRUPTED)
                stats = read_json(self.path(f"{name}.json"))
                self.assertGreater(stats["camera_paths"], 0)
                header = read_exr_header(self.path(f"{name}.exr"))
                self.assertEqual(header["wavecrest:iterations"], str(stats["iterations"]))

    def test_several_signals_at_once_are_one(self):
        process = self.started("-o", "image.exr")
        for number in (*ENDING, *ENDING):
            process.send_signal(number)
        self.end(process, INTERRUPTED)
        read_exr_header(self.path("image.exr"))

    def test_usr1_saves_and_goes_on(self):
        process = self.started("-o", "image.exr", "--stats", "stats.json")
        iterations = []
        for _ in range(2):
            self.save(process, "stats.json")
            iterations.append(read_json(self.path("stats.json"))["iterations"])
            read_exr_header(self.path("image.exr"))
            os.remove(self.path("stats.json"))
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGTERM)
        self.end(process, INTERRUPTED)
        iterations.append(read_json(self.path("stats.json"))["iterations"])
        self.assertEqual(iterations, sorted(iterations))
        self.assertGreater(iterations[0], 0)
        self.assertGreater(iterations[2], iterations[0])

    def test_a_save_for_which_there_is_no_memory_does_not_end_the_render(self):
        # The image takes 35 MB, more than malloc ever keeps for reuse of what it got from the system in one piece.
        large = ["cornell-diffuse", "--size", "2048x1408", "--threads", "1"]
        process = self.started("--partial", "-o", "image.exr", "--stats", "stats.json", scene=large, limit="60s")
        status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
        size = 1024 * int(re.search(r"^VmSize:\s+(\d+) kB$", status, re.MULTILINE)[1])
        unlimited = resource.prlimit(process.pid, resource.RLIMIT_AS)
        resource.prlimit(process.pid, resource.RLIMIT_AS, (size + (8 << 20), unlimited[1]))
        process.send_signal(signal.SIGUSR1)
        said = next((line for line in process.stderr if "no memory" in line), "")
        self.assertIn("image.exr: no memory to write it; expected ", said)
        resource.prlimit(process.pid, resource.RLIMIT_AS, unlimited)
        process.send_signal(signal.SIGTERM)
        self.end(process, INTERRUPTED)
        read_exr_header(self.path("image.exr"))

    def test_stdout_gets_the_last_statistics_alone(self):
        process = self.started("-o", "image.exr", "--stats", "-")
        for _ in range(2):
            self.save(process, "image.exr")
            os.remove(self.path("image.exr"))
        process.send_signal(signal.SIGTERM)
        output, _ = self.end(process, INTERRUPTED)
        self.assertGreater(json.loads(output)["camera_paths"], 0)

    def test_a_saved_render_is_the_same_in_the_end(self):
        arguments = ["-m", "vcm", "--spp", "8000", "-o"]  # a second and more
        self.run_wavecrest("render", *SMALL, *arguments, "whole.pfm")
        process = self.start("render", *SMALL, *arguments, "saved.pfm", "--progress", "jsonl")
        process.stderr.readline()  # from here on it heeds signals
        for _ in range(3):
            self.save(process, "saved.pfm")
            self.assertIsNone(process.poll())
            os.remove(self.path("saved.pfm"))
        self.end(process, DONE)
        whole, saved = (pathlib.Path(self.path(name)).read_bytes() for name in ("whole.pfm", "saved.pfm"))
        self.assertEqual(whole, saved)

    def test_signals_at_once_during_the_final_write_change_nothing(self):
        # The image goes through a pipe that is read late, so the write is sure to be under way.
        os.mkfifo(self.path("image.pfm"))
        process = self.start("render", "cornell-diffuse", "--size", "320x240", "--spp", "1", "-o", "image.pfm")
        with open(self.path("image.pfm"), "rb") as pipe:
            start = pipe.read(1000)
            for number in ENDING:
                process.send_signal(number)
            image = start + pipe.read()
        self.end(process, DONE)
        self.assertEqual(len(image), len(b"PF\n320 240\n-1.0\n") + 320 * 240 * 3 * 4)

    def test_an_interrupt_is_answered_while_a_scene_is_loaded(self):
        for number in ENDING:
            process = self.start("render", "-", "-o", "image.exr", stdin=subprocess.PIPE)
            process.stdin.write("<scene>" + " " * (1 << 17))  # more than a pipe holds: once it is through, it is being read
            process.stdin.flush()
            process.send_signal(number)
            _, error = self.end(process, INTERRUPTED)
            self.assertIn("before anything was rendered", error)
            self.assertFalse((self.folder / "image.exr").exists())

    def test_jsonl_is_json_only_when_a_signal_comes_while_a_scene_is_loaded(self):
        for command in ("render", "reference"):
            process = self.start(command, "-", "-o", "image.exr", "--progress", "jsonl", stdin=subprocess.PIPE)
            process.stdin.write("<scene>" + " " * (1 << 17))
            process.stdin.flush()
            process.send_signal(signal.SIGTERM)
            _, error = self.end(process, INTERRUPTED)
            self.assertRegex(json.loads(error)["message"], "^interrupted ")


class Reference(Signals):
    def begin(self):
        process = self.start("reference", "cornell-diffuse", "--size", "32x24", "--time", "10m", "-o", "r.exr")
        process.stderr.readline()  # which method, and why
        process.stderr.readline()  # the first iterations are done
        return process

    def test_term_and_hup_save(self):
        for number in (signal.SIGTERM, signal.SIGHUP):
            process = self.begin()
            process.send_signal(number)
            self.end(process, INTERRUPTED)
            self.assertGreaterEqual(int(read_exr_header(self.path("r.exr"))["wavecrest:iterations"]), 1)

    def test_usr1_saves_and_goes_on(self):
        process = self.begin()
        self.save(process, "r.exr")
        saved = int(read_exr_header(self.path("r.exr"))["wavecrest:iterations"])
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGTERM)
        self.end(process, INTERRUPTED)
        self.assertGreaterEqual(int(read_exr_header(self.path("r.exr"))["wavecrest:iterations"]), saved)


class Campaign(Signals):
    def test_term_stops_and_usr1_does_not(self):
        process = self.start("converge", "cornell-diffuse", "--methods", "pt", "--size", "32x24", "--spp", "1000000000",
                             "--out", "a", "--progress", "jsonl")  # fmt: skip
        process.stderr.readline()  # the plan
        time.sleep(0.3)
        process.send_signal(signal.SIGUSR1)
        time.sleep(0.3)
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGTERM)
        _, error = self.end(process, INTERRUPTED)
        for line in error.splitlines():
            self.assertIsInstance(json.loads(line), dict, line)
        self.assertIn("--resume", json.loads(error.splitlines()[-1])["message"])


if __name__ == "__main__":
    unittest.main()
