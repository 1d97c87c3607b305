"""What users expect of any program: names by default, lists that are complete, readers that leave early."""

import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import unittest

from harness import CHECK, DONE, INPUT, TIMEOUT_SECONDS, USAGE, WAVECREST, CommandTest, read_exr_header, read_pfm

SMALL = ["--size", "16x12", "--spp", "2", "--threads", "1", "--progress", "none"]


class Outputs(CommandTest):
    def test_a_render_without_a_name_is_named_after_its_scene(self):
        self.run_wavecrest("render", "cornell-mirror", *SMALL)
        self.assertIn("wavecrest:scene_hash", read_exr_header(self.path("cornell-mirror.exr")))
        scene = "<scene version='3.0.0'><sensor type='perspective'/><shape type='sphere'/></scene>"
        self.write("dark.xml", scene)
        self.run_wavecrest("render", "dark.xml", *SMALL)
        self.assertTrue((self.folder / "dark.exr").exists())
        result = subprocess.run(
            [WAVECREST, "render", "-", *SMALL], cwd=self.folder, input=scene.encode(), timeout=TIMEOUT_SECONDS,
            check=True, capture_output=True,
        )  # fmt: skip
        self.assertTrue((self.folder / "stdin.exr").exists(), result.stderr)

    def test_snapshots_are_named_alike(self):
        self.run_wavecrest("render", "cornell-mirror", *SMALL[:2], "--time", "100ms", "--snapshot-every", "20ms")
        self.assertTrue((self.folder / "cornell-mirror.0000.exr").exists())

    def test_a_named_image_is_the_only_one(self):
        self.run_wavecrest("render", "cornell-mirror", *SMALL, "-o", "a.pfm")
        self.assertEqual([file.name for file in self.folder.iterdir()], ["a.pfm"])

    def test_a_dry_run_names_the_image(self):
        self.assertIn("writes   cornell-mirror.exr\n", self.run_wavecrest("render", "cornell-mirror", *SMALL, "--dry-run").stdout)

    def test_a_reference_is_never_overwritten(self):
        self.run_wavecrest("render", "cornell-mirror", *SMALL)
        result = self.run_wavecrest(
            "render", "cornell-mirror", "--size", "16x12", "--until-ssim", "0.5", "--reference", "cornell-mirror.exr",
            expect=USAGE,
        )  # fmt: skip
        self.assert_one_error_line(result, r"-o cornell-mirror\.exr: is the file of --reference too")

    def test_exposure_brightens_png_alone(self):
        same = ["-o", "a.png", "-o", "a.pfm"]
        self.run_wavecrest("render", "cornell-mirror", *SMALL, *same)
        plain, floats = (self.folder / "a.png").read_bytes(), read_pfm(self.path("a.pfm"))
        self.run_wavecrest("render", "cornell-mirror", *SMALL, *same, "--exposure", "-1")
        self.assertNotEqual((self.folder / "a.png").read_bytes(), plain)
        self.assertEqual(read_pfm(self.path("a.pfm")), floats)
        # The codes are those of half the light: `compare` reads both, and shows what --exposure 0 would of half of it.
        self.write_half("half.pfm", floats)
        told = self.run_wavecrest("compare", "half.pfm", "a.png", "--metrics", "rmse", "--gamma", "--json").stdout
        self.assertLess(float(re.search(r'"rmse":\s*([\d.e+-]+)', told)[1]), 1e-6)
        result = self.run_wavecrest("render", "cornell-mirror", *SMALL, "-o", "a.pfm", "--exposure", "1", expect=USAGE)
        self.assert_one_error_line(result, r"--exposure: is for PNG images alone; expected -o FILE\.png")

    def test_exposure_takes_the_name_png_without_a_stem(self):
        self.run_wavecrest("render", "cornell-mirror", *SMALL, "-o", ".png", "--exposure", "1")
        self.assertTrue((self.folder / ".png").read_bytes().startswith(b"\x89PNG"))

    def write_half(self, name, image):
        width, height, values = image
        header = f"PF\n{width} {height}\n-1\n".encode()
        self.write(name, header + struct.pack(f"<{len(values)}f", *(value / 2 for value in values)))


class Words(CommandTest):
    def test_durations_may_be_milliseconds(self):
        for word, seconds in (("100ms", 0.1), ("1s50ms", 1.05), ("2m", 120), ("1m500ms", 60.5)):
            told = self.run_wavecrest("render", "cornell-mirror", "--size", "8x8", "--time", word, "--dry-run").stdout
            self.assertIn(f"after {seconds:g} s\n", told)
        self.run_wavecrest("render", "cornell-mirror", "--time", "100mss", "--dry-run", expect=USAGE)

    def test_every_name_that_the_error_lists_is_known(self):
        for command in (["converge", "--out", "absent", "--reference", "absent"], ["bench"], ["recommend"]):
            wrong = self.run_wavecrest(*command, "nowhere.xml", "--methods=nothing", expect=USAGE).stderr
            names = re.search("expected one of (.*)", wrong)[1].split("; ")[0].split(", ")
            self.assertIn("vcm", names)
            for name in names:
                # Known names get as far as the scene.
                result = self.run_wavecrest(*command, "nowhere.xml", f"--methods={name}", expect=INPUT)
                self.assertIn("nowhere.xml", result.stderr)
        wrong = self.run_wavecrest("converge", "--methods", "ppm-dirct", "--out", "absent", expect=USAGE).stderr
        self.assertIn("did you mean 'ppm-direct'?", wrong)

    def test_every_list_of_words_in_the_help_is_completed(self):
        script = self.write("completion", self.run_wavecrest("describe", "bash").stdout)

        def completed(*words):
            ask = f"source {script}; COMP_WORDS=({' '.join(words)}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); _wavecrest; "
            ask += 'printf "%s\\n" "${COMPREPLY[@]}"'
            told = subprocess.run(["bash", "-c", ask], capture_output=True, text=True, check=True, cwd=self.folder)
            return told.stdout.split()

        for command, option, expected in (
            ("render", "--sampler", "auto independent sobol"),
            ("reference", "--sampler", "independent sobol"),
            ("render", "--precision", "float double"),
            ("render", "--isa", "auto scalar sse4 avx2 avx512"),
            ("render", "--accel", "auto embree small bvh"),
            ("render", "--instances", "auto expand keep"),
            ("render", "--filter-mode", "spread sample"),
            ("render", "--roulette", "throughput albedo efficiency"),
            ("render", "--guide", "auto radiance variance off"),
            ("render", "--mlt", "pssmlt mmlt pathspace"),
            ("render", "--merge-vertices", "all first"),
            ("render", "--progress", "auto bar jsonl none"),
            ("reference", "-m", "auto pt lt bpt mlt ppm bpm vcm gpt evcm"),
            ("converge", "--profile", "quick standard study paper"),
            ("converge", "--methods", "pt lt bpt mlt ppm bpm vcm gpt evcm mlt-pathspace mlt-pssmlt ppm-direct "
             + " ".join(f"{method}-auto" for method in "pt lt bpt ppm bpm vcm gpt evcm".split())),
            ("converge", "--clock", "wall cpu"),
            ("converge", "--images", "all last"),
            ("bench", "--methods", "pt lt bpt mlt ppm bpm vcm gpt evcm"),
            ("bench", "--score", "small medium large"),
        ):
            self.assertEqual(sorted(completed("wavecrest", command, option, "''")), sorted(expected.split()), option)
        self.assertEqual(completed("wavecrest", "converge", "--methods", "pt,mlt-p"), ["pt,mlt-pathspace", "pt,mlt-pssmlt"])
        self.assertIn("ssim", completed("wavecrest", "compare", "--metrics", "ss"))
        self.assertNotIn("radiance", completed("wavecrest", "inspect", "--guide", "''"), "a pixel, X,Y")


class Readers(CommandTest):
    def run_into_closed_pipe(self, *arguments):
        """Stdout is a pipe whose reader has left."""
        read, write = os.pipe()
        os.close(read)
        try:
            return subprocess.run(
                [WAVECREST, *arguments], cwd=self.folder, stdout=write, stderr=subprocess.PIPE, text=True,
                timeout=TIMEOUT_SECONDS, check=False,
            )  # fmt: skip
        finally:
            os.close(write)

    def test_a_reader_that_has_enough_is_no_error(self):
        for arguments in (
            ["scenes"], ["render", "--help"], ["describe", "man"], ["inspect", "cornell-mirror"],
            ["render", "cornell-mirror", *SMALL, "--stats", "-"],
        ):  # fmt: skip
            result = self.run_into_closed_pipe(*arguments)
            self.assertEqual((result.returncode, result.stderr), (DONE, ""), arguments)

    def test_files_are_written_and_checks_made_for_a_reader_that_has_enough(self):
        test = "a" * 200 + ".pfm"  # two dozen names are more than stdio keeps for later
        for seed, image in ((1, "reference.pfm"), (2, test)):
            self.run_wavecrest("render", "cornell-mirror", *SMALL, "--seed", seed, "-o", image)
        images = ["reference.pfm", *[test] * 24]
        result = self.run_into_closed_pipe("compare", *images, "--max-rmse", "0", "--html", "p.html")
        self.assertEqual(result.returncode, CHECK, result.stderr)
        self.assertTrue((self.folder / "p.html").exists())

    def test_a_full_disk_is_one(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            result = subprocess.run(
                [WAVECREST, "scenes"], stdout=full, stderr=subprocess.PIPE, text=True, timeout=TIMEOUT_SECONDS, check=False
            )
        self.assertNotEqual(result.returncode, DONE)
        self.assertRegex(result.stderr, r"^wavecrest: error: stdout: writing failed")


class WithoutDragon(CommandTest):
    def setUp(self):
        super().setUp()
        # The scenes without what scenes/fetch-dragon gets.
        given = pathlib.Path(json.loads(self.run_wavecrest("scenes", "--json").stdout)[0]["file"]).parent
        self.scenes = self.folder / "scenes"
        shutil.copytree(given, self.scenes, ignore=shutil.ignore_patterns("references", "generate", "validation", "dragon_*"))

    def test_a_campaign_by_default_leaves_out_what_was_not_fetched(self):
        result = self.run_wavecrest(
            "converge", "--methods", "pt", "--spp", "1", "--size", "8x8", "--out", "out", "--progress", "bar",
            variables={"WAVECREST_SCENES": str(self.scenes)},
        )  # fmt: skip
        self.assertRegex(
            result.stderr,
            r"without dragon-caustics and dragon-caustics-glossy: there is no dragon_res2\.ply; scenes/fetch-dragon",
        )
        done = {line.split()[3] for line in result.stderr.splitlines() if line.startswith("[")}
        self.assertEqual(len(done), 7)

    def test_a_scene_that_was_named_is_not_left_out(self):
        result = self.run_wavecrest(
            "converge", "dragon-caustics", "--methods", "pt", "--spp", "1", "--size", "8x8", "--out", "out", expect=INPUT,
            variables={"WAVECREST_SCENES": str(self.scenes)},
        )  # fmt: skip
        self.assertIn("scenes/fetch-dragon", result.stderr)


if __name__ == "__main__":
    unittest.main()
