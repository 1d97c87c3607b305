"""bench/recommend/judge reads the committed campaigns."""

import pathlib
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).parents[3]
JUDGE = ROOT / "bench" / "recommend" / "judge"
CAMPAIGNS = [ROOT / "bench" / "campaign" / name for name in ("standard", "study")]

sys.path.insert(0, str(ROOT / "tests"))
from program_module import program_module  # noqa: E402


class Campaigns(unittest.TestCase):
    judge = program_module("bench/recommend/judge")

    def test_each_has_a_perfect_image_of_nine_scenes(self):
        for campaign in CAMPAIGNS:
            with self.subTest(campaign.name):
                perfect = self.judge.perfect_images(campaign)
                self.assertEqual(set(perfect), set(self.judge.read_curves(campaign)))
                self.assertEqual(len(perfect), 9)
                self.assertTrue(all(0.9 < ssim <= 1 for ssim in perfect.values()), perfect)

    def test_rows_are_what_a_render_takes_as_its_method(self):
        for campaign in CAMPAIGNS:
            for scene, curves in self.judge.read_curves(campaign).items():
                self.assertEqual(set(curves), {"pt", "lt", "bpt", "mlt", "ppm", "bpm", "vcm"}, f"{campaign.name} {scene}")

    def test_a_scene_that_is_not_there_is_refused(self):
        told = subprocess.run([sys.executable, JUDGE, "wavecrest", "moon"], capture_output=True, text=True)
        self.assertEqual(told.returncode, 2)
        self.assertRegex(told.stderr, r"error: \S+ has no moon; expected some of cornell-diffuse, ")


if __name__ == "__main__":
    unittest.main()
