"""Files: checked before the render, never written over each other, and what happens where they cannot be written."""

import json
import os
import pathlib
import resource
import struct
import subprocess
import unittest

from campaign_harness import ROOM
from harness import (
    DONE,
    FAILURE,
    INPUT,
    TIMEOUT_SECONDS,
    USAGE,
    WAVECREST,
    CommandTest,
    read_exr_header,
    read_json,
)

SCENE = """<scene version="3.0.0">
  <sensor type="perspective"><film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/></film></sensor>
  <shape type="sphere"><bsdf type="diffuse"><texture type="bitmap" name="reflectance">
    <string name="filename" value="texture.png"/></texture></bsdf></shape>
  <emitter type="constant"/>
</scene>
"""


class Checks(CommandTest):
    LONG = ("--time", "60s")  # ends at once where it is refused

    def test_what_cannot_be_written_is_found_before_the_render(self):
        os.mkdir(self.path("folder.exr"))
        for arguments in (
            ["-o", "folder.exr"],
            ["-o", "/proc/image.exr"],  # a folder that takes no files, not even those of root
            ["--stats", "/proc/stats.json"],
            ["--stats", "."],
            ["-o", "absent/image.exr"],
            ["-o", "image.exr", "--stats", "absent/stats.json"],
        ):
            with self.subTest(arguments):
                self.assert_one_error_line(self.render(*self.LONG, *arguments, expect=USAGE), "")
                self.assertEqual(os.listdir(self.folder), ["folder.exr"])

    def test_no_output_is_written_over_another(self):
        os.mkdir(self.path("sub"))
        for arguments in (
            ["-o", "a.exr", "-o", "a.exr"],
            ["-o", "a.exr", "-o", "sub/../a.exr"],
            ["-o", "a.exr", "--stats", "a.exr"],
            ["-o", "a.exr", "-o", "a.0003.exr", "--snapshot-every", "1s"],
            ["-o", "a.exr", "--stats", "./a.0003.exr", "--snapshot-every", "1s"],
        ):
            with self.subTest(arguments):
                result = self.render(*self.LONG, *arguments, expect=USAGE)
                self.assert_one_error_line(result, r".*expected a file of its own")
        self.render("--spp", "1", "-o", "a.exr", "-o", "a.0003.exr")  # no snapshots, no collision

    def test_no_input_is_overwritten(self):
        self.render("--spp", "1", "-o", "texture.png")
        before = pathlib.Path(self.path("texture.png")).read_bytes()
        self.write("scene.xml", SCENE)
        for arguments in (["-o", "texture.png"], ["--stats", "scene.xml"], ["--stats", "texture.png"]):
            with self.subTest(arguments):
                result = self.run_wavecrest("render", "scene.xml", *self.LONG, *arguments, expect=USAGE)
                self.assert_one_error_line(result, r".*is the file of the scene too")
        self.assertEqual(pathlib.Path(self.path("texture.png")).read_bytes(), before)
        self.assertEqual(pathlib.Path(self.path("scene.xml")).read_text(), SCENE)

    def test_a_file_that_fails_does_not_stop_the_others(self):
        os.mkfifo(self.path("first.pfm"))  # opened below, and left before the image is written
        process = subprocess.Popen(
            [WAVECREST, "render", "cornell-diffuse", "--size", "320x240", "--spp", "1", "-o", "first.pfm", "-o",
             "image.exr", "--stats", "stats.json"],
            cwd=self.folder, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        os.close(os.open(self.path("first.pfm"), os.O_RDONLY))
        error = process.communicate(timeout=TIMEOUT_SECONDS)[1]
        self.assertEqual(process.returncode, INPUT)
        self.assertRegex(error, r"wavecrest: error: first\.pfm: writing failed: Broken pipe")
        read_exr_header(self.path("image.exr"))
        read_json(self.path("stats.json"))

    def test_links_and_devices_stay_what_they_are(self):
        os.symlink("target.pfm", self.path("link.pfm"))
        self.write("target.pfm", "old")
        self.render("--spp", "1", "-o", "link.pfm", "--stats", "/dev/null")
        self.assertTrue(os.path.islink(self.path("link.pfm")))
        self.assertTrue(pathlib.Path(self.path("target.pfm")).read_bytes().startswith(b"PF"))
        self.assertFalse(os.path.isfile("/dev/null"))

    def test_a_link_to_a_file_that_is_not_there_yet_leads_to_it(self):
        os.symlink("target.pfm", self.path("link.pfm"))
        both = ("-o", "link.pfm", "-o", "target.pfm")
        self.assert_one_error_line(self.render(*self.LONG, *both, expect=USAGE), r".*expected a file of its own")
        self.render("--spp", "1", "-o", "link.pfm")
        self.assertTrue(os.path.islink(self.path("link.pfm")))
        self.assertTrue(pathlib.Path(self.path("target.pfm")).read_bytes().startswith(b"PF"))
        os.symlink("loop.pfm", self.path("loop.pfm"))
        self.assert_one_error_line(
            self.render(*self.LONG, "-o", "loop.pfm", expect=USAGE), r".*is a link that leads to no file"
        )


class Names(CommandTest):
    def run_bytes(self, *arguments):
        """Without text: what is printed has the bytes of the names."""
        return subprocess.run(
            [WAVECREST, *arguments], cwd=self.folder, timeout=TIMEOUT_SECONDS, check=False, capture_output=True
        )

    def test_names_may_be_any_bytes(self):
        (self.folder / os.fsdecode(b"s\xff.xml")).write_text(DARK)
        images = [b"a\xff.exr", b"a\xff.pfm"]
        result = self.run_bytes("render", b"s\xff.xml", "--size", "8x8", "--spp", "2", "-o", images[0], "-o", images[1],
                                "--stats", "stats.json", "--checkpoint", "c", "--progress", "jsonl")  # fmt: skip
        self.assertEqual(result.returncode, DONE, result.stderr)
        for image in images:
            self.assertTrue((self.folder / os.fsdecode(image)).exists(), image)
        self.assertEqual(read_json(self.path("stats.json"))["scene"], "s\ufffd")
        self.assertTrue((self.folder / "c").exists())
        for line in result.stderr.splitlines():
            json.loads(line)
        self.assertIsInstance(json.loads(self.run_bytes("inspect", b"s\xff.xml", "--json").stdout), dict)

    def test_a_campaign_needs_names_that_its_results_can_hold(self):
        result = self.run_bytes("converge", b"s\xff.xml", "--out", "a")
        self.assertEqual(result.returncode, USAGE)
        self.assertIn(b"is no UTF-8; expected", result.stderr)


class Streams(CommandTest):
    def run_with(self, *arguments, **streams):
        return subprocess.run(
            [WAVECREST, *arguments], cwd=self.folder, timeout=TIMEOUT_SECONDS, check=False, text=True, **streams
        )

    def test_a_minus_is_stdin_or_stdout(self):
        self.render("--spp", "1", "-o", "texture.png")
        result = self.run_with("render", "-", "--spp", "2", "--stats", "-", "--progress", "none", input=SCENE,
                               capture_output=True)  # fmt: skip
        self.assertEqual(result.returncode, DONE, result.stderr)
        stats = json.loads(result.stdout)
        self.assertEqual((stats["iterations"], stats["width"], stats["scene"]), (2, 8, "stdin"))
        broken = self.run_with("render", "-", input="<scene>\n</scene>", capture_output=True)
        self.assertEqual(broken.returncode, INPUT)
        self.assert_one_error_line(broken, r"-:1: ")

    def test_a_scene_from_stdin_is_loaded_as_often_as_need_be(self):
        options = ["--methods", "pt", "--size", "32x24", "--spp", "1", "--seeds", "1", "--out", "a", "--progress", "none"]
        scene = ROOM.replace("RADIANCE", "1")
        result = self.run_with("converge", "-", *options, input=scene, capture_output=True)
        self.assertEqual(result.returncode, DONE, result.stderr)
        result = self.run_with("reference", "-", "--size", "8x8", "--spp", "1", input=scene, capture_output=True)
        self.assertEqual(result.returncode, DONE, result.stderr)
        self.assertTrue((self.folder / "stdin.reference.exr").exists())

    def test_what_stdout_does_not_take_is_an_error(self):
        with open("/dev/full", "w") as full:
            for arguments in (["scenes"], ["inspect", "cornell-diffuse", "--json"]):
                result = self.run_with(*arguments, stdout=full, stderr=subprocess.PIPE)
                self.assertEqual(result.returncode, FAILURE)
                self.assert_one_error_line(result, r"stdout: writing failed: No space left on device")
            arguments = ["render", "cornell-diffuse", "--size", "8x8", "--spp", "1", "-o", "a.exr", "--stats", "-"]
            result = self.run_with(*arguments, stdout=full, stderr=subprocess.PIPE)
            self.assertEqual(result.returncode, INPUT)
            self.assertEqual(result.stderr.count("stdout: writing failed"), 1, result.stderr)
            read_exr_header(self.path("a.exr"))
            arguments = ["compare", "a.exr", "a.exr", "--metrics", "rmse", "--html", "-"]
            result = self.run_with(*arguments, stdout=full, stderr=subprocess.PIPE)
            self.assertEqual(result.returncode, INPUT)
            self.assert_one_error_line(result, r"stdout: writing failed: No space left on device")

    def test_nobody_has_to_listen_to_progress(self):
        for kind in ("bar", "jsonl"):
            reader, writer = os.pipe()
            os.close(reader)
            result = self.run_with("render", "cornell-diffuse", "-m", "vcm", "--size", "32x24", "--time", "0.5s",
                                   "--progress", kind, "-o", f"{kind}.exr", stderr=writer)  # fmt: skip
            os.close(writer)
            self.assertEqual(result.returncode, DONE)
            read_exr_header(self.path(f"{kind}.exr"))

    def test_closed_streams_do_not_get_into_files(self):
        command = f"{WAVECREST} render cornell-diffuse --size 8x8 --spp 1 -o a.exr --progress jsonl 0<&- 1>&- 2>&-"
        self.assertEqual(subprocess.run(["sh", "-c", command], cwd=self.folder, check=False).returncode, DONE)
        read_exr_header(self.path("a.exr"))

    def test_jsonl_is_json_only(self):
        for arguments in (
            ["render", "cornell-mirror", "-m", "vcm", "--size", "16x12", "--spp", "4", "--memory", "200M"],
            ["render", "dark.xml", "--size", "16x12", "--spp", "1"],
            ["reference", "cornell-diffuse", "--size", "16x12", "--spp", "2", "-o", "r.exr"],
            ["converge", "cornell-diffuse", "--methods", "pt", "--size", "20x20", "--spp", "1", "--out", "a"],
        ):
            with self.subTest(arguments):
                self.write("dark.xml", DARK)
                result = self.run_wavecrest(*arguments, "--progress", "jsonl")
                self.assertTrue(result.stderr)
                for line in result.stderr.splitlines():
                    self.assertIsInstance(json.loads(line), dict, line)


DARK = '<scene version="3.0.0"><sensor type="perspective"/><shape type="sphere"/></scene>'


class Warnings(CommandTest):
    def test_a_scene_without_light_renders_with_a_warning(self):
        self.write("dark.xml", DARK)
        for method in ("pt", "lt", "bpt", "ppm", "bpm", "vcm", "gpt"):
            result = self.run_wavecrest("render", "dark.xml", "-m", method, "--size", "8x8", "--spp", "1", "-o", "d.exr")
            self.assertIn("wavecrest: warning: dark.xml: the scene has no light", result.stderr)
        self.assertNotIn("no light", self.render("--spp", "1").stderr)


def exr_without_pixels(width, height):
    """A whole header and a table of blocks that are not there, for readers that do not get as far as the pixels."""
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    attributes = (
        (b"channels", b"chlist", b"Y\0" + struct.pack("<iB3xii", 1, 0, 1, 1) + b"\0"),  # halves
        (b"compression", b"compression", b"\x03"),  # ZIP, 16 rows a block
        (b"dataWindow", b"box2i", window),
        (b"displayWindow", b"box2i", window),
        (b"lineOrder", b"lineOrder", b"\0"),
        (b"pixelAspectRatio", b"float", struct.pack("<f", 1)),
        (b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0)),
        (b"screenWindowWidth", b"float", struct.pack("<f", 1)),
    )
    header = struct.pack("<2i", 20000630, 2)
    for name, kind, value in attributes:
        header += name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value
    return header + b"\0" + struct.pack("<q", 1) * (height // 16)


class Resources(CommandTest):
    def limited(self, kind, value, *arguments):
        return subprocess.run(
            [WAVECREST, *arguments], cwd=self.folder, timeout=TIMEOUT_SECONDS, check=False, text=True,
            capture_output=True, preexec_fn=lambda: resource.setrlimit(kind, (value, value)),
        )  # fmt: skip

    def test_out_of_memory_is_one_clear_line(self):
        result = self.limited(resource.RLIMIT_AS, 1 << 30, "render", "cornell-diffuse", "--size", "16000x16000",
                              "--spp", "1", "--threads", "1")  # fmt: skip
        self.assertEqual(result.returncode, FAILURE, result.stderr)
        self.assert_one_error_line(result, r"out of memory; expected")

    def test_an_image_larger_than_memory_is_no_damaged_file(self):
        self.write("large.exr", exr_without_pixels(16384, 8192))  # 1.5 GB as floats
        result = self.limited(resource.RLIMIT_AS, 1 << 30, "compare", "large.exr", "large.exr")
        self.assertEqual(result.returncode, FAILURE, result.stderr)
        self.assert_one_error_line(result, r"out of memory; expected")

    def test_threads_that_cannot_be_started_are_one_clear_line(self):
        render = ["render", "cornell-diffuse", "--size", "64x64", "--wave", "16", "--spp", "4", "--output", "x.exr"]
        # The least address space in which one thread renders, to 4 MB: no room for the stack of another.
        step, low, high = 4 << 20, 0, 512
        while high - low > 1:
            middle = (low + high) // 2
            done = self.limited(resource.RLIMIT_AS, middle * step, *render, "--threads", "1").returncode == DONE
            low, high = (low, middle) if done else (middle, high)
        result = self.limited(resource.RLIMIT_AS, high * step, *render, "--threads", "1")
        self.assertEqual(result.returncode, DONE, result.stderr)
        result = self.limited(resource.RLIMIT_AS, high * step, *render, "--threads", "400")
        self.assertEqual(result.returncode, FAILURE, result.stderr)
        self.assert_one_error_line(result, r".*expected .*--threads")


if __name__ == "__main__":
    unittest.main()
