"""bench/recommend/judge reads the committed campaigns."""

import argparse
import contextlib
import csv
import io
import json
import pathlib
import subprocess
import sys
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).parents[3]
JUDGE = ROOT / "bench" / "recommend" / "judge"
CAMPAIGNS = [ROOT / "bench" / "campaign" / name for name in ("standard", "study")]

sys.path.insert(0, str(ROOT / "tests"))
from program_module import program_module  # noqa: E402


class Campaigns(unittest.TestCase):
    judge = program_module("bench/recommend/judge")

    def test_each_scene_has_a_perfect_image(self):
        for campaign, scenes in zip(CAMPAIGNS, (9, 9)):
            with self.subTest(campaign.name):
                perfect = self.judge.perfect_images(campaign)
                self.assertEqual(set(perfect), set(self.judge.read_curves(campaign)))
                self.assertEqual(len(perfect), scenes)
                self.assertTrue(all(0.9 < ssim <= 1 for ssim in perfect.values()), perfect)

    def test_rows_are_what_a_render_takes_as_its_method(self):
        since = {"standard": set(), "study": {"gpt", "evcm"}}
        for campaign in CAMPAIGNS:
            methods = {"pt", "lt", "bpt", "mlt", "ppm", "bpm", "vcm"} | since[campaign.name]
            for scene, curves in self.judge.read_curves(campaign).items():
                self.assertEqual(set(curves), methods, f"{campaign.name} {scene}")

    def test_rows_with_the_settings_of_a_render_come_before_those_of_the_study(self):
        with open(CAMPAIGNS[1] / "measurements.csv", newline="") as lines:
            rows = [row for row in csv.DictReader(lines) if (row["scene"], row["method"]) == ("cornell-mirror", "ppm-auto")]
        curve = self.judge.read_curves(CAMPAIGNS[1])["cornell-mirror"]["ppm"]
        self.assertEqual(curve, [(float(row["seconds"]), float(row["ssim"])) for row in rows])

    def test_methods_are_those_of_the_campaign(self):
        curve = [(1.0, 0.5), (2.0, 0.7), (4.0, 0.8)]
        arguments = argparse.Namespace(program="wavecrest", budget="1s", size="64x48", threads="1", speed=1.0, here=False)
        told = json.dumps({"method": None, "predicted_seconds": None, "cannot_tell": "why", "suggested_budget": 60})
        with mock.patch.object(subprocess, "run", return_value=mock.Mock(stdout=told)) as run:
            with contextlib.redirect_stdout(io.StringIO()):
                self.assertIsNone(self.judge.judge("box", {"pt": curve, "vcm": curve}, 1.0, arguments))
        words = run.call_args.args[0]
        self.assertEqual(words[words.index("--methods") + 1], "pt,vcm")

    def test_a_target_that_is_lost_again_is_not_reached(self):
        curve = [(1, 0.5), (2, 0.95), (4, 0.8), (8, 0.96)]
        self.assertAlmostEqual(self.judge.time_to(curve, 0.9), 4 * 2 ** (0.1 / 0.16))
        self.assertIsNone(self.judge.time_to(curve[:3], 0.9))
        self.assertEqual(self.judge.time_to(curve, 0.5), 1)

    def test_targets_are_what_a_curve_keeps_from_half_of_its_run_on(self):
        self.assertEqual(self.judge.kept_from_half([(1, 0.5), (4, 0.95), (8, 0.94)]), 0.94)
        self.assertAlmostEqual(self.judge.kept_from_half([(1, 0.4), (4, 0.6), (16, 0.8), (32, 0.9)]), 0.8)
        self.assertEqual(self.judge.kept_from_half([(7, 0.8), (12, 0.9)]), float("-inf"), "it has no score at half")

    def test_a_scene_that_is_not_there_is_refused(self):
        told = subprocess.run([sys.executable, JUDGE, "wavecrest", "moon"], capture_output=True, text=True)
        self.assertEqual(told.returncode, 2)
        self.assertRegex(told.stderr, r"error: \S+ has no moon; expected some of cornell-diffuse, ")


if __name__ == "__main__":
    unittest.main()
