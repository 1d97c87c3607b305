"""bench/campaign/publish: what it writes is what the campaign measured, and nothing is published half."""

import csv
import pathlib
import sqlite3
import subprocess
import sys
import unittest

from harness import TIMEOUT_SECONDS, WAVECREST, CommandTest

PUBLISH = pathlib.Path(__file__).resolve().parents[2] / "bench" / "campaign" / "publish"
README = "# A title\n\n<!-- results -->\nold\n<!-- /results -->\n\nThe end.\n"


class Publishing(CommandTest):
    def campaign(self, scene="cornell-diffuse"):
        arguments = ["--methods", "pt,lt", "--size", "32x24", "--time", "0.05s", "--seeds", "2", "--out", "a"]
        self.run_wavecrest("converge", scene, *arguments)

    def publish(self, readme=README, plot="cornell-diffuse.ssim"):
        self.write("README.md", readme)
        command = [sys.executable, PUBLISH, "a", "--wavecrest", WAVECREST, "--to", "standard", "--readme", "README.md"]
        return subprocess.run(
            [*map(str, command), "--plot", plot],
            cwd=self.folder,
            capture_output=True,
            text=True,
            timeout=TIMEOUT_SECONDS,
            check=False,
        )

    def read(self, name):
        return pathlib.Path(self.path(name)).read_text(encoding="utf-8")

    def last_scores(self, method, metric):
        database = sqlite3.connect(self.path("a/results.sqlite"))
        query = (
            "SELECT value FROM measurement m JOIN run ON run.id = run WHERE method = ? AND metric = ? AND number = "
            "(SELECT max(number) FROM snapshot s WHERE s.run = m.run)"
        )
        scores = [value for (value,) in database.execute(query, (method, metric))]
        database.close()
        return scores

    def test_tables_and_measurements_are_those_of_the_campaign(self):
        self.campaign()
        result = self.publish()
        self.assertEqual(result.returncode, 0, result.stderr)
        page, readme = self.read("standard/README.md"), self.read("README.md")
        for method in ("pt", "lt"):
            scores = self.last_scores(method, "ssim")
            self.assertEqual(len(scores), 2)
            mean, spread = sum(scores) / 2, abs(scores[0] - scores[1]) / 2
            cell = f"{mean:.3f} <sub>±{spread:.3f}</sub>"
            self.assertIn(cell, page)
            self.assertIn(cell, readme)
        self.assertIn("](standard/README.md)", readme)
        self.assertIn('src="standard/cornell-diffuse.ssim.svg"', readme)
        self.assertTrue(readme.startswith("# A title\n\n<!-- results -->\n### "))
        self.assertTrue(readme.endswith("\n<!-- /results -->\n\nThe end.\n"))
        self.assertNotIn("\nold\n", readme)
        self.assertTrue(pathlib.Path(self.path("standard/cornell-diffuse.ssim.svg")).is_file())
        with open(self.path("standard/measurements.csv"), newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        database = sqlite3.connect(self.path("a/results.sqlite"))
        (snapshots,) = database.execute("SELECT count(*) FROM snapshot").fetchone()
        database.close()
        self.assertEqual(len(rows), snapshots)
        last = [float(row["ssim"]) for row in rows if row["method"] == "pt"]
        self.assertAlmostEqual(max(last), max(last + self.last_scores("pt", "ssim")), places=4)

    def test_findings_without_an_explanation_are_named(self):
        # One that held when explanations were written, so it has none. ppm is not measured here, so it is undecided
        # whatever the machine.
        finding = "cornell-glossy.density-estimation-poor"
        self.campaign("cornell-glossy")
        result = self.publish(plot="cornell-glossy.ssim")
        self.assertIn(finding, result.stdout)
        page = self.read("standard/README.md")
        self.assertIn(f"**undecided** | (not explained yet: `explanation` of {finding})", page)
        self.assertIn("ppm was not measured", page)

    def test_a_readme_without_a_place_for_it_is_left_alone(self):
        self.campaign()
        result = self.publish("# A title\n")
        self.assertEqual(result.returncode, 1)
        self.assertIn("has no lines <!-- results -->", result.stderr)
        self.assertEqual(self.read("README.md"), "# A title\n")


if __name__ == "__main__":
    unittest.main()
