"""wavecrest recommend: a method, a time with its interval, and a row for each method."""

import json
import unittest

from harness import DONE, USAGE, CommandTest


class Recommend(CommandTest):
    def recommend(self, *arguments, expect=DONE):
        return self.run_wavecrest("recommend", "cornell-diffuse", "--size", "32x24", "--threads", "2", *arguments,
                                  expect=expect)

    def test_the_table_has_every_method_and_the_best_one_first(self):
        told = self.recommend("--budget", "3s", "--target-ssim", "0.8", "--methods", "pt,lt,bpt", "--json")
        result = json.loads(told.stdout)
        self.assertEqual({row["method"] for row in result["table"]}, {"pt", "lt", "bpt"})
        self.assertEqual(result["method"], result["table"][0]["method"])
        times = [row["predicted_seconds"] for row in result["table"] if row["predicted_seconds"] is not None]
        self.assertEqual(times, sorted(times))
        self.assertEqual(result["predicted_seconds"], times[0])
        low, high = result["interval"]
        self.assertTrue(0 < low <= times[0] <= high)

    def test_the_text_is_a_paragraph_and_a_table(self):
        told = self.recommend("--budget", "1s", "--target-ssim", "0.5", "--methods", "pt")
        self.assertRegex(told.stdout, r"(?m)^cornell-diffuse: use pt\. It gets to an SSIM of 0\.5 in about")

    def test_without_whole_images_it_cannot_tell(self):
        told = self.run_wavecrest("recommend", "lafortune-room", "--size", "640x480", "--threads", "2", "--budget", "0.1s")
        self.assertRegex(told.stdout, r"^lafortune-room: cannot tell within 0\.1 s; try --budget [0-9]+[smh]\. ")
        self.assertNotIn("never", told.stdout)

    def test_a_second_can_be_one_of_cpu_time(self):
        told = self.recommend("--budget", "1s", "--target-ssim", "0.5", "--methods", "pt,vcm", "--clock", "cpu", "--json")
        for row in json.loads(told.stdout)["table"]:
            self.assertAlmostEqual(row["pilot_seconds"], 0.25, delta=0.15)
        self.assert_one_error_line(self.recommend("--clock", "moon", expect=USAGE), "--clock")

    def test_a_single_method_has_one_pilot_of_all_the_time(self):
        told = self.recommend("--budget", "2s", "--target-ssim", "0.5", "--methods", "pt", "--clock", "cpu", "--json")
        (row,) = json.loads(told.stdout)["table"]
        # 0.6 of the budget. A longer pilot of one among several has 0.25.
        self.assertGreater(row["pilot_seconds"], 1.1)

    def test_what_cannot_be_is_a_usage_error(self):
        self.recommend("--target-ssim", "1.5", expect=USAGE)
        self.assert_one_error_line(self.recommend("--methods", "xx", expect=USAGE), "--methods xx: unknown")


if __name__ == "__main__":
    unittest.main()
