"""Inputs that are no files, or not as wavecrest writes them, end in one line and exit code 2 or 3, and at once."""

import copy
import json
import os
import pathlib
import random
import sqlite3
import struct
import unittest
import zlib

from harness import INPUT, USAGE, CommandTest

SMALL = ["--size", "16x16", "--threads", "1"]


class Names(CommandTest):
    def refused(self, *arguments):
        """One line that says what is wrong, and exit code 2 or 3."""
        process = self.start(*arguments)
        _, error = process.communicate(timeout=60)
        self.assertIn(process.returncode, (USAGE, INPUT), (arguments, error))
        last = error.splitlines()[-1]
        self.assertRegex(last, r"^wavecrest: error: .+", (arguments, error))
        self.assertNotIn("internal error", error)

    def test_empty_names(self):
        self.render("--spp", "1", "-o", "a.pfm")
        for command in ("render", "inspect", "reference", "recommend", "converge", "bench", "report"):
            self.refused(command, "")
        self.refused("convert", "", "-o", "a.xml")
        self.refused("compare", "", "a.pfm")
        self.refused("compare", "a.pfm", "")
        self.refused("compare", "a.pfm", "a.pfm", "--map", "")
        self.refused("bench", "--compare", "", "")
        self.refused("bench", "--against", "")
        for option in ("-o", "--stats", "--checkpoint", "--time", "--size", "--reference"):
            self.refused("render", "cornell-diffuse", *SMALL, "--spp", "1", option, "")

    def test_loops_of_links(self):
        for name in ("loop", "loop.exr", "loop.xml", "loop.json"):
            os.symlink(name, self.path(name))
        self.render("--spp", "1", "-o", "a.exr")
        self.refused("render", "loop.xml")
        self.refused("compare", "loop.exr", "a.exr")
        self.refused("report", "loop")
        self.refused("reference", "cornell-diffuse", *SMALL, "--spp", "1", "-o", "loop.exr")
        self.refused("render", "cornell-diffuse", *SMALL, "--spp", "1", "--checkpoint", "loop", "--resume")
        self.refused("converge", "cornell-diffuse", "--spp", "1", "--methods", "pt", "--size", "16x16", "--out", "loop")
        self.refused("bench", "--compare", "loop.json", "loop.json")
        self.refused("--config", "loop", "render", "cornell-diffuse", *SMALL, "--spp", "1")

    def test_pipes_and_devices_without_end(self):
        os.mkfifo(self.path("pipe"))
        os.mkfifo(self.path("pipe.exr"))
        os.mkdir(self.path("folder"))
        os.mkfifo(self.path("folder/stats.json"))
        self.render("--spp", "1", "-o", "a.exr")
        for name in ("pipe", "/dev/zero"):
            self.refused("render", name)
            self.refused("bench", "--compare", name, name)
            self.refused("--config", name, "render", "cornell-diffuse", *SMALL, "--spp", "1")
            self.refused("render", "cornell-diffuse", *SMALL, "--spp", "1", "--checkpoint", name, "--resume")
            self.refused("report", name)
            self.refused("merge", name, "-o", "b.exr")
        os.chmod(self.path("pipe"), 0o700)
        self.refused("bench", "cornell-diffuse", "--against", self.path("pipe"))
        self.refused("compare", "pipe.exr", "a.exr")
        self.refused("reference", "cornell-diffuse", *SMALL, "--spp", "1", "-o", "b.exr", "--agree-with", "pipe.exr")
        self.refused("report", "folder")


class Stored(CommandTest):
    def one_line(self, *arguments):
        result = self.run_wavecrest(*arguments, expect=INPUT)
        self.assertRegex(result.stderr.splitlines()[-1], "^wavecrest: error: ", arguments)

    def test_results_of_bench_with_other_values(self):
        slices = [{"visit": i // 2, "cpu_seconds": 1.0 + 0.01 * i, "paths": 1000} for i in range(8)]
        method = {"method": "pt", "scaling": [{"threads": 1, "slices": slices}]}
        scene = {"scene": "s", "width": 8, "height": 8, "methods": [method]}
        whole = {"machine": {"cpu": "c", "cores": 2}, "scenes": [scene]}
        self.write("whole.json", json.dumps(whole))
        self.run_wavecrest("bench", "--compare", "whole.json", "whole.json")
        first = ("scenes", 0, "methods", 0, "scaling", 0, "slices", 0)
        places = [("machine",), ("machine", "cpu"), ("machine", "cores"), ("scenes",), ("scenes", 0), ("scenes", 0, "width"),
                  (*first[:3],), (*first[:4],), (*first[:4], "method"), (*first[:5],), (*first[:6],), (*first[:7],), first,
                  (*first, "visit"), (*first, "cpu_seconds"), (*first, "paths")]  # fmt: skip
        for place in places:
            for value in (None, [], {}, "text", -1, 0, True):
                changed = copy.deepcopy(whole)
                inner = changed
                for key in place[:-1]:
                    inner = inner[key]
                if isinstance(value, type(inner[place[-1]])):
                    continue
                inner[place[-1]] = value
                self.write("changed.json", json.dumps(changed))
                result = self.run_wavecrest("bench", "--compare", "changed.json", "changed.json", expect=None)
                self.assertIn(result.returncode, (0, INPUT), (place, value, result.stderr))
                self.assertNotIn("internal error", result.stderr)

    def checkpoint(self, header=lambda _: None, state=lambda data: data):
        """A checkpoint whose header and state were changed by who knows the format."""
        data = pathlib.Path(self.path("whole.ck")).read_bytes()
        begin = data.index(b"\n") + 1
        (size,) = struct.unpack_from("<Q", data, begin)
        parsed = json.loads(data[begin + 8 : begin + 8 + size])
        parsed = header(parsed) or parsed
        text = json.dumps(parsed, separators=(",", ":")).encode()
        body = data[:begin] + struct.pack("<Q", len(text)) + text + state(data[begin + 8 + size : -4])
        self.write("changed.ck", body + struct.pack("<I", zlib.crc32(body)))

    def test_checkpoints_made_by_hand(self):
        for method in ("pt", "ppm", "vcm", "mlt"):
            render = ["render", "cornell-diffuse", *SMALL, "-m", method, "--wave", "256", "-o", "a.pfm"]
            render += ["--chains", "500", "--bootstrap", "4096"] if method == "mlt" else []
            (self.folder / "whole.ck").unlink(missing_ok=True)
            self.run_wavecrest(*render, "--spp", "2", "--checkpoint", "whole.ck")
            # Notes are read alike for all methods.
            for key in ("wall_seconds", "snapshot_every", "snapshots") if method == "pt" else ():
                for value in ("text", [1], [[1, 2, 3, 4]], {"a": 1}, None):
                    def change(header, key=key, value=value):
                        header["notes"] = {**header["notes"], "snapshots": [], key: value}
                        if value is None:
                            del header["notes"][key]
                    self.checkpoint(header=change)
                    result = self.run_wavecrest(*render, "--spp", "2", "--checkpoint", "changed.ck", "--resume", expect=None)
                    self.assertIn(result.returncode, (0, INPUT), (key, value, result.stderr))
            for change in (
                lambda header: header.update(cut=[]), lambda header: header.update(cut={"threads": "two"}),
                lambda header: header.update(cut={"threads": 0}), lambda header: header.update(cut={"threads": 1 << 31}),
                lambda header: header.update(render=[]), lambda header: header.update(render=1), lambda header: [1],
            ):  # fmt: skip
                self.checkpoint(header=change)
                self.one_line(*render, "--spp", "2", "--checkpoint", "changed.ck", "--resume")
            # Whatever the state holds, the render goes on, ends or refuses it.
            chance = random.Random(7)
            for _ in range(12):
                def change(data):
                    data = bytearray(data)
                    for _ in range(4):
                        at = chance.randrange(min(len(data), chance.choice((64, 1 << 20))) - 8)
                        data[at : at + 8] = struct.pack("<Q", chance.choice((0, 1, 1 << 20, 1 << 40, (1 << 64) - 1)))
                    return bytes(data)
                self.checkpoint(state=change)
                result = self.run_wavecrest(*render, "--spp", "3", "--checkpoint", "changed.ck", "--resume", expect=None)
                self.assertIn(result.returncode, (0, INPUT), result.stderr)
                self.assertNotIn("internal error", result.stderr)

    def test_campaigns_whose_texts_are_no_json(self):
        campaign = ["--methods", "pt", "--size", "16x16", "--spp", "1", "--seeds", "1", "--out", "a"]
        for statement in ("UPDATE run SET stats = '['", "UPDATE run SET stats = '[]'",
                          "UPDATE run SET stats = '{\"iterations\":\"1\"}'",
                          "UPDATE campaign SET value = '1' WHERE key = 'options'",
                          "UPDATE campaign SET value = '{' WHERE key = 'options'"):  # fmt: skip
            self.run_wavecrest("converge", "cornell-diffuse", *campaign)
            with sqlite3.connect(self.path("a/results.sqlite")) as database:
                database.execute(statement)
            database.close()
            self.one_line("converge", "--out", "a", "--resume")
            for path in sorted(self.folder.rglob("*"), reverse=True):
                path.rmdir() if path.is_dir() else path.unlink()

    def test_references_that_are_not_finite_do_not_go_on(self):
        render = ["reference", "cornell-diffuse", *SMALL, "-o", "r.exr", "--spp"]
        self.run_wavecrest(*render, "2")
        whole = pathlib.Path(self.path("r.exr")).read_bytes()
        # The attribute is text; another of the same length takes its place.
        at = whole.index(b"wavecrest:render_seconds\0string\0") + len(b"wavecrest:render_seconds\0string\0")
        (size,) = struct.unpack_from("<i", whole, at)
        for text in (b"nan(" + b"0" * (size - 5) + b")", b"-" + b"1" * (size - 1)):
            self.write("r.exr", whole[: at + 4] + text + whole[at + 4 + size :])
            self.one_line(*render, "4")


if __name__ == "__main__":
    unittest.main()
