"""wavecrest render --until-ssim: ends when the reference is resembled, and says so."""

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

    def test_what_does_not_fit_together_is_refused(self):
        for arguments in (
            ("--until-ssim", "0.9"),
            ("--reference", "x.exr"),
            ("--until-ssim", "0.9", "--reference", "x.exr", "--snapshot-every", "1s", "-o", self.path("x.exr")),
        ):
            self.assert_one_error_line(self.render(*arguments, expect=USAGE), "--")

    def test_a_reference_of_another_size_is_bad_input(self):
        reference = self.path("reference.exr")
        self.run_wavecrest("render", "cornell-diffuse", "--size", "16x16", "--spp", "1", "-o", reference)
        result = self.render("--until-ssim", "0.9", "--reference", reference, expect=INPUT)
        self.assert_one_error_line(result, ".*is 16x16; expected the render's 32x24")


if __name__ == "__main__":
    unittest.main()
