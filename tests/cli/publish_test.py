"""bench/campaign/publish: what it writes is what the campaign measured, and nothing is published half."""

import csv
import importlib.machinery
import importlib.util
import json
import pathlib
import re
import sqlite3
import subprocess
import sys
import unittest

from harness import TIMEOUT_SECONDS, WAVECREST, CommandTest

CAMPAIGN = pathlib.Path(__file__).resolve().parents[2] / "bench" / "campaign"
PUBLISH, RESTORE = CAMPAIGN / "publish", CAMPAIGN / "restore"
README = "# A title\n\n<!-- results -->\nold\n<!-- /results -->\n\nThe end.\n"


def publish_module():
    """bench/campaign/publish, a program without an ending, as a module."""
    sys.path.insert(0, str(CAMPAIGN))
    loader = importlib.machinery.SourceFileLoader("publish", str(PUBLISH))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("publish", loader))
    loader.exec_module(module)
    return module


class Publishing(CommandTest):
    def campaign(self, scene="cornell-diffuse", methods="pt,lt"):
        arguments = ["--methods", methods, "--size", "32x24", "--time", "0.05s", "--seeds", "2", "--out", "a"]
        self.run_wavecrest("converge", scene, *arguments)

    def publish(self, readme=README, plot="cornell-diffuse.ssim", program=WAVECREST):
        self.write("README.md", readme)
        command = [sys.executable, PUBLISH, "a", "--wavecrest", program, "--to", "standard", "--readme", "README.md"]
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
            shown = re.findall(r"(-?[\d.]+) <sub>±([\d.]+)</sub>", page.split("## SSIM")[1].split("## ")[0])
            self.assertTrue(all(float(s) > 0 for _, s in shown), "a spread that rounds to zero is shown with more digits")
            # The page rounds what the CSV has rounded before.
            self.assertTrue(
                any(abs(float(m) - mean) < 0.0011 and abs(float(s) - spread) < 0.0011 for m, s in shown), (scores, shown)
            )
        self.assertIn("](standard/README.md)", readme)
        self.assertIn('src="standard/overview.relmse.svg"', readme)
        self.assertIn("| scene | first to SSIM 0.95 | first to Q_MOS 90 |", readme)
        self.assertRegex(readme, r"\| cornell-diffuse \| (pt|lt|–)[^|]* \|")
        overview = self.read("standard/overview.relmse.svg")
        self.assertEqual(overview.count("<polyline"), 2)
        self.assertIn(">cornell-diffuse</text>", overview)
        for metric, label in (("ssim", ">0.75</text>"), ("q_mos", ">75</text>"), ("rmse", "<polyline")):
            self.assertIn(label, self.read(f"standard/overview.{metric}.svg"))
            self.assertIn(f"](overview.{metric}.svg)", page)
        self.assertTrue(readme.startswith("# A title\n\n<!-- results -->\nWho is first to look right"))
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

    def test_spreads_are_never_shown_as_zero(self):
        publish = publish_module()
        row = {"mean": "0.9944", "low": "0.9940", "high": "0.9948", "seeds": "2"}
        self.assertEqual(publish.band(row, "{:.3f}"), "0.994 <sub>±0.0004</sub>")
        self.assertEqual(publish.band({**row, "low": "0.99", "high": "0.9988"}, "{:.3f}"), "0.994 <sub>±0.004</sub>")
        self.assertEqual(publish.band({**row, "low": "0.9948"}, "{:.3f}"), "0.994")
        for spread, shown in ((4.96e-4, "0.0005"), (3e-5, "0.00003"), (1e-4, "0.0001"), (9.7e-5, "0.0001")):
            self.assertEqual(publish.shown_spread(spread, "{:.3f}"), shown)

    def test_what_cannot_be_judged_is_not_counted(self):
        self.campaign(methods="bpm")  # of which the study says nothing
        result = self.publish()
        page, readme = self.read("standard/README.md"), self.read("README.md")
        self.assertIn("none of the study's", result.stdout)
        self.assertIn("without an explanation: none", result.stdout)
        self.assertRegex(page, r"\*\*not judged\*\* \| [^|]*(was not measured|paths per pixel)[^|]*<details>")
        self.assertRegex(page, r"Not judged, and counted neither way, as .*too few scenes can be judged \(2\)")
        self.assertIn("The study's findings: none of the study's", readme)

    def test_open_findings_without_an_explanation_are_named(self):
        self.campaign()
        # As another program judges: publish judges by its own conditions, so these are put in its place.
        stub = self.write(
            "judge",
            f"""#!/bin/sh
{WAVECREST} "$@" && {sys.executable} - <<'END'
import csv
rows = list(csv.DictReader(open("a/claims.csv")))
rows[0].update(verdict="does not hold", figure="SSIM of pt is 0.5, limit 0.9", explanation="")
rows[1].update(verdict="holds", figure="RMSE lt 2, pt 1")
rows[2].update(verdict="does not hold", figure="RMSE lt 1, pt 2", explanation="Noise of short runs. It falls with time.")
rows[3].update(verdict="undecided", figure="RMSE lt 1, pt 1.1")
rows[4].update(verdict="not reached in this time", figure="SSIM of lt is 0.8; at this rate 0.9 after 9 s (8 to 10 s)", explanation="")
with open("a/claims.csv", "w") as file:
    writer = csv.DictWriter(file, rows[0].keys())
    writer.writeheader()
    writer.writerows(rows)
END
""",
        )
        pathlib.Path(stub).chmod(0o755)
        result = self.publish(program=stub)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("1 hold, 2 do not, 1 not in this time, 1 are undecided", result.stdout)
        self.assertIn("without an explanation: cornell-diffuse.all-converge", result.stdout)
        self.assertIn("The study's findings: 1 hold, 2 do not, 1 not in this time, 1 are undecided", self.read("README.md"))
        page = self.read("standard/README.md")
        self.assertRegex(page, r"Judged here: 5 of its \d+ findings. 1 hold: cornell-diffuse: ")
        self.assertIn("Does not hold: cornell-diffuse: All methods converge (SSIM of pt is 0.5, limit 0.9).", page)
        self.assertRegex(page, r"\nNot reached in this time: [^\n]*\(SSIM of lt is 0\.8; at this rate 0\.9 after 9 s \(8 to 10 s\)\)\.\n")
        self.assertRegex(page, r"\n1 are undecided within noise: [^\n]*\(RMSE lt 1, pt 1\.1\)\.\n")
        self.assertRegex(page, r"\(RMSE lt 1, pt 2\)\. Noise of short runs\. It falls with time\.\n")
        self.assertIn("Noise of short runs. It falls with time.<br>", page)
        self.assertIn("(not explained yet: cornell-diffuse.all-converge in explanations.json)", page)

    def test_a_campaign_is_restored_from_what_was_published(self):
        self.campaign()
        self.publish()
        subprocess.run([sys.executable, RESTORE, "standard", "b"], cwd=self.folder, check=True, capture_output=True)
        self.run_wavecrest("report", "b", "--judge", "--csv")

        def claims(folder):
            with open(self.path(f"{folder}/claims.csv"), newline="", encoding="utf-8") as file:
                return [(row["id"], row["verdict"], row["figure"]) for row in csv.DictReader(file)]

        self.assertEqual(claims("b"), claims("a"))
        self.assertGreater(len(claims("a")), 1)

        def rows(folder, query):
            database = sqlite3.connect(self.path(f"{folder}/results.sqlite"))
            found = database.execute(query).fetchall()
            database.close()
            return found

        ((stats,), *_) = rows("b", "SELECT stats FROM run WHERE method = 'lt'")
        self.assertGreater(json.loads(stats)["light_paths"], 0)
        biases = "SELECT * FROM bias ORDER BY scene, method, number"
        self.assertEqual(rows("b", biases), rows("a", biases))
        self.assertGreater(len(rows("a", biases)), 0)

    def test_a_readme_without_a_place_for_it_is_left_alone(self):
        self.campaign()
        result = self.publish("# A title\n")
        self.assertEqual(result.returncode, 1)
        self.assertIn("has no lines <!-- results -->", result.stderr)
        self.assertEqual(self.read("README.md"), "# A title\n")


if __name__ == "__main__":
    unittest.main()
