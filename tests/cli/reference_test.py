"""Reference images: what the file says, going on with it, and what survives kill and Ctrl-C."""

import os
import pathlib
import random
import signal
import subprocess
import time
import unittest

from harness import DONE, INPUT, INTERRUPTED, USAGE, WAVECREST, CommandTest, read_exr_header


KILLS = int(os.environ.get("KILLS", "3"))


class Reference(CommandTest):
    def reference(self, *arguments, scene="cornell-diffuse", size="32x24", expect=DONE):
        return self.run_wavecrest("reference", scene, "--size", size, "--threads", "2", *arguments, expect=expect)

    def header(self, name):
        return read_exr_header(self.path(name))

    def test_the_file_says_how_it_was_made_and_how_good_it_is(self):
        self.reference("--spp", "4", "-o", "r.exr")
        header = self.header("r.exr")
        self.assertEqual(header["dataWindow"], (0, 0, 31, 23))
        for channel in (b"R\0", b"difference.R\0", b"variance.B\0"):
            self.assertIn(channel, header["channels"])
        self.assertEqual(header["wavecrest:iterations"], "4")
        self.assertEqual(header["wavecrest:scene"], "cornell-diffuse")
        self.assertTrue(header["wavecrest:method"] and header["wavecrest:method_reason"])
        for metric in ("rmse", "relmse", "ssim", "q_mos", "flip"):
            float(header["wavecrest:noise_floor." + metric])

    def test_by_trials_it_says_what_they_chose(self):
        self.reference("--method", "evcm", "--spp", "2", "-o", "r.exr")
        header = self.header("r.exr")
        self.assertIn(header["wavecrest:method"], ("pt", "lt", "bpt", "vcm"))
        self.assertEqual(header["wavecrest:biased"], "true" if header["wavecrest:method"] == "vcm" else "false")
        self.reference("--method", "evcm", "--spp", "4", "-o", "r.exr")
        self.assertEqual(self.header("r.exr")["wavecrest:iterations"], "4", "they choose the same again")

    def test_running_it_again_goes_on(self):
        errors = []
        for spp in ("4", "16", "64"):
            self.reference("--spp", spp, "-o", "r.exr")
            self.assertEqual(self.header("r.exr")["wavecrest:iterations"], spp)
            errors.append(float(self.header("r.exr")["wavecrest:relative_error"]))
        # A factor of two each; anything beyond 1.4 says that the samples are new ones.
        self.assertGreater(errors[0], 1.4 * errors[1])
        self.assertGreater(errors[1], 1.4 * errors[2])

    def test_chains_go_on_as_others(self):
        errors = []
        for spp in ("4", "8"):  # one step of all chains each
            self.reference("--method", "mlt", "--spp", spp, "-o", "r.exr")
            self.assertEqual(self.header("r.exr")["wavecrest:iterations"], spp)
            errors.append(float(self.header("r.exr")["wavecrest:relative_error"]))
        # A factor of sqrt(2). The same chains again would have left the halves as they were.
        self.assertGreater(errors[0], 1.2 * errors[1])

    def test_chains_have_the_depth_that_they_follow(self):
        depth = '<integrator type="path"><integer name="max_depth" value="99"/></integrator>'
        sphere = '<shape type="sphere"><point name="center" x="0" y="0" z="4"/></shape>'
        scene = f'<scene version="3.0.0">{depth}<sensor type="perspective"/><emitter type="constant"/>{sphere}</scene>'
        mlt = ("--method", "mlt", "-o", "r.exr")
        result = self.reference(*mlt, "--spp", "1", scene=self.write("deep.xml", scene))
        self.assertIn("the scene's max_depth of 99 is more than mlt can follow; 64 is used", result.stderr)
        self.assertEqual(self.header("r.exr")["wavecrest:max_depth"], "64")
        # Files of earlier versions have the scene's.
        file = self.folder / "r.exr"
        before, attribute = file.read_bytes(), b"wavecrest:max_depth\0string\0\2\0\0\0"
        self.assertEqual(before.count(attribute + b"64"), 1)
        file.write_bytes(before.replace(attribute + b"64", attribute + b"99"))
        self.reference(*mlt, "--spp", "2", scene="deep.xml")
        self.assertEqual(self.header("r.exr")["wavecrest:iterations"], "2")
        self.assertEqual(self.header("r.exr")["wavecrest:max_depth"], "64")

    def test_a_goal_that_is_reached_changes_nothing(self):
        self.reference("--spp", "64", "-o", "r.exr")
        before = pathlib.Path(self.path("r.exr")).read_bytes()
        self.reference("--spp", "64", "-o", "r.exr")
        self.reference("--until-relative-error", "0.9", "-o", "r.exr")
        self.assertEqual(pathlib.Path(self.path("r.exr")).read_bytes(), before)

    def test_a_compact_one_is_measured_against_but_not_gone_on_with(self):
        self.reference("--spp", "4", "-o", "whole.exr", "--compact", "r.exr")
        header = self.header("r.exr")
        self.assertEqual(header["wavecrest:samples"], "half")
        self.assertNotIn(b"variance.B\0", header["channels"])
        self.assertEqual(header["wavecrest:noise_floor.ssim"], self.header("whole.exr")["wavecrest:noise_floor.ssim"])
        before = pathlib.Path(self.path("r.exr")).read_bytes()
        result = self.reference("--spp", "8", "--quiet", "-o", "r.exr", expect=INPUT)
        self.assert_one_error_line(result, r"r\.exr: its samples is 'half', not 'float'; expected")
        self.assertEqual(pathlib.Path(self.path("r.exr")).read_bytes(), before)
        compared = self.run_wavecrest("compare", "r.exr", "whole.exr", "--metrics", "ssim")
        self.assertRegex(compared.stdout, r"ssim +mean (1|0\.9999)")

    def test_a_small_one_begins_with_a_larger_one(self):
        self.reference("--spp", "2", "-o", "large.exr", size="64x48")
        self.reference("--from", "large.exr", "-o", "r.exr")
        header = self.header("r.exr")
        self.assertEqual(header["dataWindow"], (0, 0, 31, 23))
        self.assertEqual(header["wavecrest:iterations"], "8")
        self.assertEqual(header["wavecrest:render_seconds"], self.header("large.exr")["wavecrest:render_seconds"])
        self.reference("--spp", "12", "-o", "r.exr")
        self.assertEqual(self.header("r.exr")["wavecrest:iterations"], "12")
        for arguments, text in (
            (["--from", "large.exr", "-o", "r.exr"], r"r\.exr: exists; expected a new file to begin from large\.exr"),
            (["--from", "r.exr", "-o", "s.exr"], r"r\.exr: is 32x24 pixels; expected a whole multiple of 32x24"),
            (["--from", "large.exr", "--seed", "3", "-o", "s.exr"], r"large\.exr: its seed is '0', not '3'"),
            (["--from", "nowhere.exr", "-o", "s.exr"], r"nowhere\.exr"),
        ):
            self.assert_one_error_line(self.reference("--quiet", *arguments, expect=INPUT), text)
        self.assertFalse((self.folder / "s.exr").exists())

    def test_what_a_killed_writer_left_is_removed(self):
        self.write("r.exr.tmp.1.0", "part of a reference")
        self.reference("--spp", "1", "-o", "r.exr")
        self.assertFalse((self.folder / "r.exr.tmp.1.0").exists())

    def test_goals_by_time_and_error(self):
        self.reference("--time", "0.3s", "-o", "time.exr")
        self.assertGreaterEqual(float(self.header("time.exr")["wavecrest:render_seconds"]), 0.3)
        self.reference("--until-relative-error", "0.2", "-o", "error.exr")
        self.assertLessEqual(float(self.header("error.exr")["wavecrest:relative_error"]), 0.2)

    def test_a_black_one_is_told(self):
        dark = self.write("dark.xml", '<scene version="3.0.0"><sensor type="perspective"/><shape type="sphere"/></scene>')
        result = self.reference("--method", "pt", scene=dark, size="16x16", expect=INPUT)
        self.assertRegex(result.stderr.splitlines()[-1], r"error: dark\.reference\.exr: is black after \d+ iterations")

    def test_a_variable_that_is_for_renders_is_no_mistake(self):
        self.run_wavecrest("reference", "cornell-diffuse", "--size", "16x16", "--spp", "1", "-o", "r.exr",
                           variables={"WAVECREST_SAMPLER": "auto"})  # fmt: skip
        self.assertEqual(self.header("r.exr")["wavecrest:sampler"], "independent")
        self.reference("--sampler", "auto", expect=USAGE)

    def test_another_reference_is_not_overwritten(self):
        self.reference("--spp", "1", "-o", "r.exr")
        result = self.reference("--spp", "2", "--seed", "3", "--quiet", "-o", "r.exr", expect=INPUT)
        self.assert_one_error_line(result, r"r\.exr: its seed is '0', not '3'; expected")

    def test_a_plain_render_is_not_gone_on_with(self):
        self.run_wavecrest("render", "cornell-diffuse", "--size", "32x24", "--spp", "1", "-o", "r.exr")
        before = pathlib.Path(self.path("r.exr")).read_bytes()
        result = self.reference("--spp", "2", "--quiet", "-o", "r.exr", expect=INPUT)
        self.assert_one_error_line(result, r"r\.exr: is a plain image, without the two halves of a reference")
        self.assertEqual(pathlib.Path(self.path("r.exr")).read_bytes(), before)

    def test_one_process_at_a_time_works_on_a_reference(self):
        command = [WAVECREST, "reference", "cornell-diffuse", "--size", "32x24", "--time", "10m", "-o", "r.exr"]
        first = subprocess.Popen(command, cwd=self.folder, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL)
        self.addCleanup(first.kill)
        first.stderr.readline()  # which method, and why
        first.stderr.readline()  # the first iterations are done
        result = self.reference("--spp", "2", "--quiet", "-o", "r.exr", expect=INPUT)
        self.assert_one_error_line(result, rf"r\.exr: process {first.pid} on .* works on it; expected one at a time")
        first.terminate()
        first.communicate(timeout=60)
        self.reference("--spp", "2", "-o", "r.exr")
        self.assertEqual([path.name for path in self.folder.iterdir()], ["r.exr"])

    def test_what_it_is_to_agree_with_is_read_before_rendering(self):
        self.reference("--spp", "1", "-o", "small.exr")
        self.run_wavecrest("render", "cornell-diffuse", "--size", "64x48", "--spp", "1", "-o", "plain.exr")
        for other, answer in (
            ("nowhere.exr", r"nowhere\.exr: "),
            ("small.exr", r"small\.exr: is 32x24 pixels; expected 64x48$"),
            ("plain.exr", r"plain\.exr: a reference without halves"),
        ):
            arguments = ["--quiet", "--time", "10m", "-o", "r.exr", "--agree-with", other]
            self.assert_one_error_line(self.reference(*arguments, size="64x48", expect=INPUT), answer)
        self.assertFalse((self.folder / "r.exr").exists())

    def test_the_line_of_a_bar_is_ended(self):
        lines = self.reference("--progress", "bar", "--spp", "2", "-o", "r.exr").stderr
        self.assertTrue(lines.endswith("\n"))
        for line in lines.splitlines():
            if "iterations of each half" in line:
                self.assertRegex(line, r"relative error [\d.]+ *$")

    def test_wrong_words_and_files(self):
        result = self.reference("--method", "pt", "--radius", "0.01", "--quiet", expect=USAGE)
        self.assert_one_error_line(result, r"--radius: pt does not merge; expected ppm, bpm, vcm or evcm$")
        self.reference("--method", "pt", "--radius", "0.001", "--spp", "1", "-o", "default.exr")
        self.reference("--quiet", "--progress", "loud", expect=USAGE)
        self.reference("--method", "guess", expect=USAGE)
        self.reference("--until-relative-error", "0", expect=USAGE)
        self.reference("-o", "r.png", expect=USAGE)
        self.reference("-o", "nowhere/r.exr", expect=USAGE)
        self.write("r.exr", "no image")
        self.reference("--quiet", "-o", "r.exr", expect=INPUT)
        self.run_wavecrest("reference", "nowhere.xml", expect=INPUT)

    def test_interrupt_saves_what_there_is(self):
        command = [WAVECREST, "reference", "cornell-diffuse", "--size", "32x24", "--time", "10m", "-o", "r.exr"]
        process = subprocess.Popen(command, cwd=self.folder, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL)
        process.stderr.readline()  # which method, and why
        process.stderr.readline()  # the first iterations are done
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, INTERRUPTED)
        self.assertGreaterEqual(int(self.header("r.exr")["wavecrest:iterations"]), 1)

    def test_a_signal_or_a_kill_leaves_a_reference_or_none(self):
        chance = random.Random(11)
        spp, hits = 0, 0
        while hits < KILLS:
            spp += 64
            command = [WAVECREST, "reference", "cornell-diffuse", "--size", "32x24", "--spp", str(spp), "-o", "r.exr"]
            process = subprocess.Popen(
                command, cwd=self.folder, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL
            )
            time.sleep(chance.uniform(0, 0.04))  # some are done by then
            number = chance.choice((signal.SIGKILL, signal.SIGTERM))
            process.send_signal(number)
            self.assertIn(process.wait(), (DONE, INTERRUPTED, -number))
            hits += process.returncode != DONE
            self.reference("--spp", spp, "-o", "r.exr")
            self.assertEqual(self.header("r.exr")["wavecrest:iterations"], str(spp))
        self.reference("--spp", spp, "-o", "whole.exr")
        self.run_wavecrest("compare", "whole.exr", "r.exr", "--max-rmse", "1e-4")  # of rounding; of another seed 0.04


if __name__ == "__main__":
    unittest.main()
