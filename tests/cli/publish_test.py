"""bench/campaign/publish: what it writes is what the campaign measured, and nothing is published half."""

import csv
import json
import pathlib
import re
import sqlite3
import subprocess
import sys
import unittest

from harness import WAVECREST
from publish_harness import MADE_UP, RESTORE, ROOT, PublishTest, remove_runs, remove_scores  # which makes curves be found

import curves


class Publishing(PublishTest):
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
        self.assertRegex(page, r"publish DIR --to (\S+/standard|FOLDER) --readme (\S+/README.md|FILE)\n")
        self.assertIn("](standard/README.md)", readme)
        self.assertIn('src="standard/overview.relmse.svg"', readme)
        self.assertRegex(readme, r"\| cornell-diffuse \| (pt|lt|–)[^|]* \|")
        overview = self.read("standard/overview.relmse.svg")
        self.assertEqual(overview.count("<polyline"), 2)
        self.assertIn(">cornell-diffuse</text>", overview)
        for metric, label in (("ssim", ">0.75</text>"), ("q_mos", ">75</text>"), ("rmse", "<polyline")):
            self.assertIn(label, self.read(f"standard/overview.{metric}.svg"))
            self.assertIn(f"](overview.{metric}.svg)", page)
        self.assertTrue(readme.startswith("# A title\n\n<!-- results -->\nWhich method is first at SSIM 0.95"))
        self.assertTrue(readme.endswith("\n<!-- /results -->\n\nThe end.\n"))
        self.assertNotIn("\nold\n", readme)
        figure = self.read("standard/cornell-diffuse.svg")
        self.assertRegex(figure, r'<image [^>]*href="data:image/(png|jpeg);base64,[A-Za-z0-9+/=]{100}')
        self.assertEqual(figure.count("<polyline"), 2 * 3, "two methods by RMSE, SSIM and Q_MOS")
        self.assertIn("](cornell-diffuse.svg)", page)
        with open(self.path("standard/measurements.csv"), newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        database = sqlite3.connect(self.path("a/results.sqlite"))
        (snapshots,) = database.execute("SELECT count(*) FROM snapshot").fetchone()
        database.close()
        self.assertEqual(len(rows), snapshots)
        last = [float(row["ssim"]) for row in rows if row["method"] == "pt"]
        self.assertAlmostEqual(max(last), max(last + self.last_scores("pt", "ssim")), places=4)

    def test_times_and_speed_ups_are_those_of_the_report(self):
        self.made_up_campaign()
        self.assertEqual(self.publish().returncode, 0)
        with open(self.path("a/measurements.csv"), newline="", encoding="utf-8") as file:
            series = curves.read_series(csv.DictReader(file))
        with open(self.path("a/summary.csv"), newline="", encoding="utf-8") as file:
            rows = [row for row in csv.DictReader(file) if row["target"] and row["metric"] == "ssim"]
        times = []
        for row in rows:
            time = curves.time_to(series[row["scene"], row["method"], "ssim"], float(row["target"]), higher=True)
            shown = (float(row["seconds_to_target"]), row["at_most"] == "yes") if row["seconds_to_target"] else None
            self.assertEqual(time is None, shown is None, row)
            if time:
                self.assertAlmostEqual(time[0], shown[0], places=9)
                self.assertEqual(time[1], shown[1], row)
                times.append(time)
        self.assertEqual({at_most for _, at_most in times}, {True, False}, "both kinds of times are compared")
        report = self.read("a/report.html").split("<summary>over pt</summary>")[1].split("</table>")[0]
        for method in ("bpt", "vcm-auto"):
            cells = re.findall(r"<td[^>]*>([^<]*)", report.split(f"</i>{method}")[1].split("<tr>")[0])
            pairs = [(series.get((scene, method, "relmse")), series.get((scene, "pt", "relmse"))) for scene in MADE_UP]
            own = [curves.speed_up(*pair) if all(pair) else None for pair in pairs]
            signs = {0: "", 1: "≥ ", -1: "≤ "}
            shown = [f"{signs[f[1]]}{f[0]:.3g} ×" if f else "–" for f in (curves.geometric_mean(own), *own)]
            self.assertEqual(shown, cells)

    def test_campaigns_that_are_not_done_are_refused(self):
        self.campaign()
        database = sqlite3.connect(self.path("a/results.sqlite"))
        # One that is being extended: no run has the new time yet.
        database.execute("UPDATE campaign SET value = '0.1' WHERE key = 'time'")
        database.commit()
        self.assertIn("cornell-diffuse: runs of 0.05 s, not of 0.1 s; expected", self.publish().stderr)
        database.execute("UPDATE campaign SET value = '0.05' WHERE key = 'time'")
        (stats,) = database.execute("SELECT stats FROM run WHERE id = 1").fetchone()
        longer = json.dumps({**json.loads(stats), "asked_seconds": 0.1})
        database.execute("UPDATE run SET stats = ? WHERE id = 1", [longer])
        database.commit()
        self.assertIn("runs of 0.05 s and 0.1 s", self.publish().stderr)
        database.execute("UPDATE run SET stats = ?, seed = 3, state = 'refused' WHERE id = 1", [stats])
        database.commit()
        self.assertIn("seeds of cornell-diffuse pt are missing", self.publish().stderr)
        # One that was stopped after pt, and before its second scene.
        database.execute("UPDATE run SET seed = 1, state = 'done' WHERE id = 1")
        remove_runs(database, "method = 'lt'")
        database.execute("UPDATE campaign SET value = value || ' cornell-mirror' WHERE key = 'scenes'")
        database.commit()
        open_pairs = "cornell-diffuse lt, cornell-mirror pt, cornell-mirror lt"
        self.assertIn(f"publish: {open_pairs}: neither rendered nor refused; expected", self.publish().stderr)
        database.close()
        self.assertFalse(pathlib.Path(self.path("standard")).exists(), "nothing is written")

    def test_runs_without_measurements_are_refused(self):
        self.made_up_campaign()
        database = sqlite3.connect(self.path("a/results.sqlite"))
        remove_scores(database, "id = 1")
        database.commit()
        database.close()
        self.assertIn("publish: cornell-diffuse pt seed 1: no measurements; expected", self.publish().stderr)
        measurements = self.read("published/measurements.csv").splitlines()
        self.write("published/measurements.csv", "\n".join(measurements[:-3]) + "\n")
        for folder, pattern in (("published", "published: veach-door vcm-auto seed 1 is not in both"), ("none", ".*none/campaign.json")):
            result = subprocess.run(
                [sys.executable, RESTORE, folder, "c"], cwd=self.folder, capture_output=True, text=True, check=False
            )
            self.assertEqual(result.returncode, 1)
            self.assertRegex(result.stderr, rf"^restore: {pattern}[^\n]*\n$")
        self.assertFalse(pathlib.Path(self.path("c")).exists(), "nothing is written")

    def test_refused_rows_are_published_and_restored(self):
        self.made_up_campaign()
        self.assertEqual(self.publish().returncode, 0)
        facts = json.loads(self.read("standard/campaign.json"))
        refused = {"method": "vcm-auto", "seed": 1, "reason": "cannot", "stats": {}}
        self.assertEqual(facts["refused"][0], {"scene": "lafortune-room", **refused})
        self.assertEqual([(row["scene"], row["method"]) for row in facts["refused"][1:]], [("veach-door", "pt")])

    def test_campaigns_by_iterations_are_refused(self):
        self.run_wavecrest("converge", "cornell-diffuse", "--methods", "pt", "--size", "32x24", "--spp", "2", "--out", "a")
        self.assertIn("counts iterations", self.publish().stderr)

    def test_tables_have_the_best_methods_and_what_they_gain(self):
        self.made_up_campaign()
        self.assertEqual(self.publish().returncode, 0)
        page, readme = self.read("standard/README.md"), self.read("README.md")
        perfect = "<br><sub>perfect image 0.930</sub>"
        for row in (
            "| cornell-diffuse | bpt | 32 s | vcm-auto" + perfect + " | 10 s | 3.2 |",
            "| cornell-mirror | – <sub>bpt 0.940</sub> |  | vcm-auto" + perfect + " | 10 s | ≥ 10 |",
            "| cornell-glossy | – <sub>bpt 0.940</sub> |  | – <sub>bpt 0.940</sub>" + perfect + " |  | – |",
            "| veach-door | – <sub>bpt 0.940</sub> |  | vcm-auto" + perfect + " | ≤ 1 s | ≥ 100 |",
        ):
            self.assertIn(row, readme)
        self.assertEqual(len(re.findall(r"^\|(---\|)+$", readme, re.MULTILINE)), 1, "one table")
        self.assertEqual(readme.count("<img"), 1)
        # No Q_MOS was measured, so the table has the two targets of SSIM.
        self.assertIn("| scene | rows | SSIM 0.9 | SSIM 0.95 |", page)
        self.assertIn("| cornell-diffuse | study<br>all | bpt 10 s<br>vcm-auto 7.2 s | bpt 32 s<br>vcm-auto 10 s", page)
        speeds = page.split("## Speed-up over pt")[1].split("## ")[0]
        self.assertIn("– where one of them has none, and where a mean would be of bounds of both kinds; ≥", speeds)
        self.assertIn("| scene | bpt | vcm-auto |", speeds)
        self.assertIn("| cornell-diffuse | 1.3 | 10 |", speeds)
        self.assertIn("| veach-door | – | – |", speeds)
        self.assertIn("| lafortune-room | ≥ 100 | – |", speeds)
        self.assertRegex(speeds, r"geometric mean\*\* \| ≥ [^|]* <sub>of 4</sub> \| ≤ [^|]* <sub>of 3</sub> \|")

    def test_references_of_the_repository_are_not_made_first(self):
        self.made_up_campaign()
        for folder, made in ((ROOT / "scenes" / "references", 0), (self.folder / "references", 1)):
            database = sqlite3.connect(self.path("a/results.sqlite"))
            database.execute("INSERT OR REPLACE INTO campaign VALUES('reference_folder', ?)", [str(folder)])
            database.commit()
            database.close()
            self.assertEqual(self.publish().returncode, 0)
            page = self.read("standard/README.md")
            self.assertEqual(page.count("bench/campaign/remake-references --size"), made)
            self.assertEqual(page.count(" --reference "), made)
            self.assertIs(json.loads(self.read("standard/campaign.json"))["own_references"], bool(made))

    def test_names_of_scenes_may_have_blanks(self):
        self.made_up_campaign({name: MADE_UP["cornell-diffuse"] for name in ("my room", "my house")})
        database = sqlite3.connect(self.path("a/results.sqlite"))
        database.execute("INSERT OR REPLACE INTO campaign VALUES('time', 'my room=100 my house=50')")
        database.execute("INSERT OR REPLACE INTO campaign VALUES('snapshots', 'my room=log my house=5')")
        # The second one is under way.
        remove_runs(database, "scene = 'my house' AND method = 'pt'")
        database.commit()
        database.close()
        self.assertIn("publish: my house pt: neither rendered nor refused; expected", self.publish().stderr)
        result = self.publish("--under-way")
        self.assertEqual(result.returncode, 0, result.stderr)
        page, settings = self.read("standard/README.md"), json.loads(self.read("standard/campaign.json"))["settings"]
        self.assertIn("](my%20room.svg)", page)
        self.assertIn(", 100 s a run, ", page)
        self.assertNotIn("my house", page)
        self.assertTrue(pathlib.Path(self.path("standard/my room.svg")).exists())
        asked = [settings[key] for key in ("scenes", "time", "snapshots")]
        self.assertEqual(asked, ["my room", "my room=100", "my room=log"])

    def test_figures_have_what_was_measured(self):
        self.made_up_campaign()
        (self.folder / "standard").mkdir()
        for name in ("campaign.json", "cornell-glossy.relmse.svg"):
            self.write(f"standard/{name}", "of an earlier page")
        self.assertEqual(self.publish().returncode, 0)
        figures = {path.stem for path in pathlib.Path(self.path("standard")).glob("*.svg")}
        self.assertEqual(figures, {*MADE_UP, "overview.relmse", "overview.ssim"}, "without those of an earlier page")
        figure = self.read("standard/cornell-diffuse.svg")
        self.assertIn("<image", figure, "the repository's reference, as restored results have no images")
        self.assertEqual(re.findall(r'class="name">([^<]*)<', figure), ["cornell-diffuse", "SSIM", "Time to equal relMSE"])
        self.assertEqual(figure.count("<polyline"), 3)
        # Lines of -auto rows are dashed, in the panel and in the legend.
        self.assertEqual(figure.count("stroke-dasharray=\"7 4\""), 2)
        # pt and bpt take ten and 2.8 times as long as vcm-auto to where they end.
        self.assertEqual(re.findall(r"<rect [^>]*>\n<text[^>]*>([^<]*)<", figure), ["10", "2.8", "1"])

    def test_pictures_are_those_of_their_scenes_beside_one_that_all_rows_refuse(self):
        self.made_up_campaign()
        database = sqlite3.connect(self.path("a/results.sqlite"))
        remove_scores(database, "scene = 'cornell-diffuse'")
        database.execute("UPDATE run SET state = 'refused', reason = 'has no light' WHERE scene = 'cornell-diffuse'")
        database.commit()
        database.close()
        result = self.publish()
        self.assertEqual(result.returncode, 0, result.stderr)
        report = self.read("a/report.html")
        for scene in MADE_UP:
            picture = re.search(rf'<h2>{scene}</h2>.*?data-name="reference".*?src="([^"]+)"', report, re.DOTALL)[1]
            if scene == "cornell-diffuse":
                self.assertFalse(pathlib.Path(self.path(f"standard/{scene}.svg")).exists())
            else:
                self.assertIn(f'href="{picture}"', self.read(f"standard/{scene}.svg"))

    def test_what_cannot_be_judged_is_not_counted(self):
        self.campaign(methods="bpm")  # of which the study says nothing
        result = self.publish()
        page, readme = self.read("standard/README.md"), self.read("README.md")
        self.assertIn("none of the study's", result.stdout)
        self.assertIn("without an explanation: none", result.stdout)
        self.assertRegex(page, r"\*\*Not judged:\*\* [^\n]*(was not measured|paths per pixel)")
        self.assertRegex(page, r"Not judged, and counted neither way: .*too few scenes can be judged \(2\)")
        self.assertIn("| cornell-diffuse | – |  | ", readme)
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
        self.assertIn("1 holds, 2 do not, 1 not in this time, 1 is undecided", result.stdout)
        self.assertIn("without an explanation: cornell-diffuse.all-converge", result.stdout)
        self.assertIn("The study's findings: 1 holds, 2 do not, 1 not in this time, 1 is undecided", self.read("README.md"))
        page = self.read("standard/README.md")
        paragraphs = [line for line in page.splitlines() if line.startswith("The study: ")]
        self.assertEqual(len(paragraphs), 2, "one of the scene, one of all scenes")
        paragraph = paragraphs[0]
        self.assertTrue(paragraph.startswith("The study: We noticed all methods converge to the reference solution."))
        self.assertIn(
            "Here: **Does not hold:** All methods converge (SSIM of pt is 0.5, limit 0.9). "
            "(Not explained yet: cornell-diffuse.all-converge in explanations.json.) **Holds:** ",
            paragraph,
        )
        self.assertIn("(RMSE lt 1, pt 2). Noise of short runs. It falls with time.", page)
        self.assertRegex(page, r"\*\*Not reached in this time:\*\* [^\n]*0\.9 after 9 s \(8 to 10 s\)\)\.")
        self.assertRegex(page, r"\*\*Undecided:\*\* [^\n]*\(RMSE lt 1, pt 1\.1\)\.")

    def test_a_readme_without_a_place_for_it_is_left_alone(self):
        self.campaign()
        result = self.publish(readme="# A title\n")
        self.assertEqual(result.returncode, 1)
        self.assertIn("has no lines <!-- results -->", result.stderr)
        self.assertEqual(self.read("README.md"), "# A title\n")
        pathlib.Path(self.path("README.md")).unlink()
        result = self.publish(readme=None)
        self.assertRegex(result.stderr, r"^publish: README\.md does not exist; expected [^\n]*\n$")
        self.assertFalse(pathlib.Path(self.path("standard")).exists(), "nothing is written")


if __name__ == "__main__":
    unittest.main()
