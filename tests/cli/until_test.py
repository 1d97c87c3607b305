"""wavecrest render --until-ssim, --until-relative-error: ends when the goal is reached, and says so."""

import unittest

from harness import DONE, INPUT, USAGE, CommandTest, read_json


class Until(CommandTest):
    def stats_of(self, *arguments):
        self.result = self.render(*arguments, "--stats", self.path("stats.json"), expect=DONE)
        return read_json(self.path("stats.json"))

    def test_an_ssim_is_reached(self):
        reference = self.path("reference.exr")
        self.render("--spp", "1000", "-o", reference)
        until = self.stats_of("--until-ssim", "0.8", "--reference", reference, "--seed", "1")["until"]
        self.assertTrue(until["reached"] and until["ssim"] >= 0.8, until)
        self.assertRegex(self.result.stderr, r"reached after \d+ iterations: SSIM 0\.\d+, goal 0\.8")
        until = self.stats_of("--until-ssim", "0.999", "--reference", reference, "--spp", "5")["until"]
        self.assertEqual((until["reached"], until["iterations"]), (False, 5))
        ended = ["--until-ssim", "0.8", "--reference", reference, "--time", "1e-9s", "--stats", self.path("none.json")]
        told = self.render(*ended, "-o", self.path("none.exr"), expect=INPUT)
        self.assertIn("not reached after 0 iterations: SSIM not known yet, goal 0.8", told.stderr)
        self.assertIsNone(read_json(self.path("none.json"))["until"]["ssim"])

    def test_a_relative_error_is_reached_and_told_with_its_interval(self):
        stats = self.stats_of("--until-relative-error", "0.3", "--seed", "1")
        until = stats["until"]
        self.assertEqual(stats["sampler"], "independent")  # which is known after a few iterations
        low, high = until["interval"]
        self.assertTrue(until["reached"] and low <= until["relative_error"] <= high <= 0.3, until)
        self.assertRegex(self.result.stderr, r"reached after \d+ iterations: relative error 0\.\d+, 0\.\d+ to 0\.\d+ "
                                             r"with 95 % confidence, goal 0\.3")
        until = self.stats_of("--until-relative-error", "0.1", "--seed", "1", "--sampler", "sobol")["until"]
        self.assertTrue(until["reached"] and until["iterations"] == 8 * 64, until)  # of eight runs
        until = self.stats_of("--until-relative-error", "0.001", "--spp", "5")["until"]
        self.assertEqual((until["reached"], until["relative_error"]), (False, None))
        self.stats_of("--until-relative-error", "0.4", "-m", "ppm", "--spp", "8")
        self.assertRegex(self.result.stderr, "leaves out the bias of merging")
        # By what renders, where trials choose it.
        stats = self.stats_of("--until-relative-error", "0.3", "-m", "evcm")
        self.assertNotEqual(stats["choice"]["method"], "vcm")
        self.assertNotIn("bias of merging", str(stats["notes"]))

    def test_films_without_variance_and_without_light_end(self):
        self.write("sky.xml", '<scene version="3.0.0"><sensor type="perspective"/><emitter type="constant"/>'
                   '<shape type="sphere"><point name="center" x="0" y="0" z="-10"/></shape></scene>')  # behind
        sky = ["render", "sky.xml", "--size", "16x16", "--stats", "sky.json", "-o", "sky.pfm"]
        self.run_wavecrest(*sky, "--until-relative-error", "0.01")
        self.assertTrue(read_json(self.path("sky.json"))["until"]["reached"])
        self.write("dark.xml", '<scene version="3.0.0"><sensor type="perspective"/><shape type="sphere"/></scene>')
        dark = ["render", "dark.xml", "--size", "16x16", "-o", "dark.pfm", "--until-relative-error", "0.01"]
        result = self.run_wavecrest(*dark, expect=INPUT)
        self.assertRegex(result.stderr.splitlines()[-1], r"error: --until-relative-error: after \d+ iterations .* is black")
        self.assertFalse((self.folder / "dark.pfm").exists())
        self.run_wavecrest(*dark, "--spp", "600")

    def test_what_does_not_fit_together_is_refused(self):
        for arguments in (
            ("--until-ssim", "0.9"),
            ("--reference", "x.exr"),
            ("--until-ssim", "0.9", "--reference", "x.exr", "--until-relative-error", "0.1"),
            ("--until-ssim", "0.9", "--reference", "x.exr", "--snapshot-every", "1s", "-o", self.path("y.exr")),
        ):
            self.assert_one_error_line(self.render(*arguments, expect=USAGE), "--")
        refused = self.render("--until-relative-error", "0.1", "-m", "mlt", expect=USAGE)
        self.assert_one_error_line(refused, "--until-relative-error: .*; expected another method$")
        goal = ["render", "cornell-diffuse", "--until-relative-error", "0.5", "--quiet"]
        refused = self.run_wavecrest(*goal, "--size", "5x3", expect=USAGE)
        self.assert_one_error_line(refused, "--until-relative-error: a film of 5x3 is too small .*; expected 16 pixels or more$")
        self.run_wavecrest(*goal, "--size", "4x4", "--spp", "1")
        # Seventeen films of 12 bytes a pixel.
        refused = self.run_wavecrest(*goal, "--size", "640x480", "--memory", "62M", "--dry-run", expect=USAGE)
        self.assert_one_error_line(refused, r"--memory: the films that .* take 62\.7 MB; expected more than that$")
        refused = self.run_wavecrest(*goal, "--size", "640x480", "--memory", "70M", "--dry-run", expect=USAGE)
        self.assert_one_error_line(refused, r"--memory: this scene needs \d+ MB at least by pt")
        plan = self.run_wavecrest(*goal, "--size", "640x480", "--memory", "100M", "--dry-run").stdout
        self.assertIn("and 62.7 MB for the films that tell the error\n", plan)

    def test_a_reference_of_another_size_is_bad_input(self):
        reference = self.path("reference.exr")
        self.run_wavecrest("render", "cornell-diffuse", "--size", "16x16", "--spp", "1", "-o", reference)
        result = self.render("--until-ssim", "0.9", "--reference", reference, expect=INPUT)
        self.assert_one_error_line(result, ".*is 16x16; expected the render's 32x24")


if __name__ == "__main__":
    unittest.main()
