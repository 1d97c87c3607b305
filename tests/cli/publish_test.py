"""bench/campaign/publish: what it writes is what the campaign measured, and nothing is published half."""

import csv
import json
import pathlib
import re
import shutil
import sqlite3
import subprocess
import sys
import types
import unittest

from harness import INPUT, TIMEOUT_SECONDS, WAVECREST, CommandTest

ROOT = pathlib.Path(__file__).resolve().parents[2]
CAMPAIGN = ROOT / "bench" / "campaign"
sys.path[:0] = [str(CAMPAIGN), str(ROOT / "tests")]
PUBLISH, RESTORE = CAMPAIGN / "publish", CAMPAIGN / "restore"
import curves  # noqa: E402
import scene_figure  # noqa: E402
import svg_plot  # noqa: E402
from program_module import program_module  # noqa: E402

README = "# A title\n\n<!-- results -->\nold\n<!-- /results -->\n\nThe end.\n"


# Scores of a made-up campaign after 1, 10 and 100 seconds: (SSIM, relMSE) by scene and method.
PT, BPT, AUTO = (
    ((0.5, 0.7, 0.9), (1, 0.1, 0.01)),
    ((0.5, 0.9, 1.0), (0.5, 0.05, 0.005)),
    ((0.6, 0.95, 0.99), (0.1, 0.01, 0.001)),
)
SLOW, BAD, FAST = (
    ((0.5, 0.6, 0.94), (1, 0.5, 0.2)),
    ((0.1, 0.2, 0.3), (9, 5, 2)),
    ((0.96, 0.97, 0.98), (0.003, 0.002, 0.001)),
)
MADE_UP = {
    "cornell-diffuse": {"pt": PT, "bpt": BPT, "vcm-auto": AUTO},
    "cornell-mirror": {"pt": PT, "bpt": SLOW, "vcm-auto": AUTO},
    "cornell-glossy": {"pt": PT, "bpt": SLOW, "vcm-auto": BAD},
    "lafortune-room": {"pt": PT, "bpt": FAST},
    "veach-door": {"bpt": SLOW, "vcm-auto": FAST},
}


class Publishing(CommandTest):
    def campaign(self, scene="cornell-diffuse", methods="pt,lt"):
        arguments = ["--methods", methods, "--size", "32x24", "--time", "0.05s", "--seeds", "2", "--out", "a"]
        self.run_wavecrest("converge", scene, *arguments)

    def made_up_campaign(self, scenes=MADE_UP):
        """A results file with these scores, in "a"."""
        facts = json.loads((CAMPAIGN / "standard" / "campaign.json").read_text())
        methods = [m for m in ("pt", "bpt", "vcm-auto") if any(m in scores for scores in scenes.values())]
        facts["settings"].update(methods=" ".join(methods), scenes=" ".join(scenes), seeds="1", time="100")
        facts["scenes"] = {scene: {"hash": "0", "noise_floors": {"ssim": 0.93}} for scene in scenes}
        facts["biases"] = []
        stats = {"threads": 1, "iterations": 1000, "render_seconds": 100.0, "camera_paths": 1000}
        runs = [(scene, method, scores) for scene, rows in scenes.items() for method, scores in rows.items()]
        facts["runs"] = [{"scene": scene, "method": method, "seed": 1, "stats": stats} for scene, method, _ in runs]
        lines = ["scene,method,seed,snapshot,seconds,iterations,ssim,relmse"]
        for scene, method, scores in runs:
            for k, (ssim, relmse) in enumerate(zip(*scores)):
                lines.append(f"{scene},{method},1,{k},{10**k},{10**k},{ssim},{relmse}")
        (self.folder / "published").mkdir()
        self.write("published/campaign.json", json.dumps(facts))
        self.write("published/measurements.csv", "\n".join(lines) + "\n")
        subprocess.run([sys.executable, RESTORE, "published", "a"], cwd=self.folder, check=True, capture_output=True)

    def publish(self, readme=README, program=WAVECREST):
        if readme:
            self.write("README.md", readme)
        command = [sys.executable, PUBLISH, "a", "--wavecrest", program, "--to", "standard", "--readme", "README.md"]
        return subprocess.run(
            [*map(str, command)],
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

    def test_values_that_are_none_are_left_out_of_times_and_make_the_end_none(self):
        nan = float("nan")
        series = [[(0, 1.0, 0.5), (1, 10.0, nan), (2, 100.0, 0.9)], [(0, 3.0, 0.7), (1, 30.0, nan), (2, 300.0, nan)]]
        self.assertEqual(curves.mean_curve(series), [(2.0, 0.6), (100.0, 0.9)])
        self.assertAlmostEqual(curves.time_to(series, 0.75, higher=True)[0], 2.0 * 50.0**0.5)
        self.assertNotEqual(curves.final_value(series), curves.final_value(series), "NaN")
        self.assertIsNone(curves.speed_up(series, [[(0, 1.0, 0.5)]]))
        self.assertIsNone(curves.geometric_mean([(2.0, 1), (3.0, -1)]))
        self.assertEqual(curves.geometric_mean([(2.0, 1), None, (8.0, 0)]), (4.0, 1))

    def test_a_score_that_is_lost_again_is_not_reached(self):
        series = [[(0, 1.0, 0.95), (1, 2.0, 0.6), (2, 4.0, 0.9)]]
        self.assertEqual(curves.time_to(series, 0.9, higher=True), (4.0, False))
        self.assertIsNone(curves.time_to([[(0, 1.0, 0.5), (1, 2.0, 0.95), (2, 4.0, 0.8)]], 0.9, higher=True))

    def test_campaigns_that_are_not_done_are_refused(self):
        self.campaign()
        database = sqlite3.connect(self.path("a/results.sqlite"))
        (stats,) = database.execute("SELECT stats FROM run WHERE id = 1").fetchone()
        longer = json.dumps({**json.loads(stats), "asked_seconds": 0.1})
        database.execute("UPDATE run SET stats = ? WHERE id = 1", [longer])
        database.commit()
        self.assertIn("runs of 0.05 s and 0.1 s", self.publish().stderr)
        database.execute("UPDATE run SET stats = ?, seed = 3, state = 'refused' WHERE id = 1", [stats])
        database.commit()
        self.assertIn("seeds of cornell-diffuse pt are missing", self.publish().stderr)
        database.close()
        self.assertFalse(pathlib.Path(self.path("standard")).exists(), "nothing is written")

    def test_runs_without_measurements_are_refused(self):
        self.made_up_campaign()
        database = sqlite3.connect(self.path("a/results.sqlite"))
        database.execute("DELETE FROM measurement WHERE run = 1")
        database.execute("DELETE FROM snapshot WHERE run = 1")
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
        self.assertIn("| scene | bpt | vcm-auto |", speeds)
        self.assertIn("| cornell-diffuse | 1.3 | 10 |", speeds)
        self.assertIn("| veach-door | – | – |", speeds)
        self.assertIn("| lafortune-room | ≥ 100 | – |", speeds)
        self.assertRegex(speeds, r"geometric mean\*\* \| ≥ [^|]* <sub>of 4</sub> \| ≤ [^|]* <sub>of 3</sub> \|")

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
        self.assertEqual(self.times_of(360.0), ["0 s", "100 s", "200 s", "300 s"])
        self.assertEqual(self.times_of(10.0), ["0 s", "5 s", "10 s"])

    def times_of(self, seconds):
        """Labels of the axes of time in a scene's figure with a run of that time."""
        series = [[(0, 0.1 * seconds, 0.5), (1, seconds, 0.9)]]
        campaign = types.SimpleNamespace(
            methods=["pt"], pictures={}, floors={}, series={("a", "pt", m): series for m in ("rmse", "ssim", "relmse")}
        )
        labels = re.findall(r">(\d+ s)<", scene_figure.scene_figure(campaign, "a"))
        self.assertEqual(labels, 2 * labels[: len(labels) // 2], "the same in both panels")
        return labels[: len(labels) // 2]

    def test_a_long_legend_has_the_studys_rows_first(self):
        methods = ["pt", "ppm-auto", "lt", "bpm-auto", "bpt", "vcm-auto", "mlt-pathspace", "mlt", "ppm", "gpt-auto", "vcm", "evcm-auto"]
        parts, lines = svg_plot.legend(methods)
        self.assertEqual(lines, 2)
        first = [re.search(r">([^<]*)<", part)[1] for part in parts if part.startswith("<text") and 'y="26.0"' in part]
        self.assertEqual(first, ["pt", "lt", "bpt", "mlt-pathspace", "ppm", "vcm"])
        ends = [float(x) for part in parts for x in re.findall(r'x2="([\d.]+)"', part)]
        self.assertLess(max(ends), svg_plot.WIDTH - 90, "names are within the figure")
        self.assertEqual(svg_plot.legend(["pt", "vcm-auto"])[1], 1)

    def test_spreads_are_never_shown_as_zero(self):
        publish = program_module("bench/campaign/publish")
        row = {"mean": "0.9944", "low": "0.9940", "high": "0.9948", "seeds": "2"}
        self.assertEqual(publish.band(row, "{:.3f}"), "0.994 <sub>±0.0004</sub>")
        self.assertEqual(publish.band({**row, "low": "0.99", "high": "0.9988"}, "{:.3f}"), "0.994 <sub>±0.004</sub>")
        self.assertEqual(publish.band({**row, "low": "0.9948"}, "{:.3f}"), "0.994")
        for spread, shown in ((4.96e-4, "0.0005"), (3e-5, "0.00003"), (1e-4, "0.0001"), (9.7e-5, "0.0001")):
            self.assertEqual(publish.shown_spread(spread, "{:.3f}"), shown)

    def test_facts_that_differ_name_their_scenes(self):
        publish = program_module("bench/campaign/publish")
        runs = [("x", "pt", 1, {"cpu": "A"}), ("y", "pt", 1, {"cpu": "B"}), ("z", "pt", 1, {}), ("x", "lt", 1, {"cpu": "A"})]
        campaign = types.SimpleNamespace(settings={"cpu": "A, B"}, runs=runs)
        self.assertEqual(publish.by_scene(campaign, "cpu"), "A (x, z) and B (y)")
        campaign.runs = runs[2:]
        self.assertEqual(publish.by_scene(campaign, "cpu"), "A")

    def test_references_that_the_repository_lacks_are_not_said_to_be_checked(self):
        publish = program_module("bench/campaign/publish")
        stats = {"asked_seconds": 9.0, "threads": 2}

        def notes(scenes, own=False):
            settings = {"size": "1024x768", "clock": "cpu", "seeds": "2"}
            campaign = types.SimpleNamespace(scenes=scenes, settings=settings, own_references=own, runs=[("x", "pt", 1, stats)])
            return publish.study_notes(campaign)

        agrees = "a second one agrees with it"
        self.assertIn(f"{agrees}. How good", notes(["cornell-diffuse"]))
        self.assertIn(f"{agrees}, but for of-others: of this machine, and not checked. How", notes(["cornell-diffuse", "of-others"]))
        for text in (notes(["of-others"]), notes(["cornell-diffuse"], own=True)):
            self.assertIn("they are those of this machine", text)
            self.assertNotIn(agrees, text)

    def test_the_spread_of_seeds_is_that_of_the_standard_campaign(self):
        claims = ROOT / "bench" / "claims"
        spread = subprocess.run([sys.executable, claims / "seed-spread"], check=True, capture_output=True, text=True)
        self.assertEqual(spread.stdout, (claims / "seed_spread.json").read_text())

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
        self.assertIn("1 hold, 2 do not, 1 not in this time, 1 are undecided", result.stdout)
        self.assertIn("without an explanation: cornell-diffuse.all-converge", result.stdout)
        self.assertIn("The study's findings: 1 hold, 2 do not, 1 not in this time, 1 are undecided", self.read("README.md"))
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
        own = "SELECT count(*) FROM campaign WHERE key = 'reference_folder'"
        self.assertEqual(rows("b", own), rows("a", own))
        # It goes on with a further scene, and what was there stays.
        scores = "SELECT m.* FROM run JOIN measurement m ON run.id = m.run WHERE scene = 'cornell-diffuse' ORDER BY 1, 2, 3"
        before = rows("b", scores)
        self.run_wavecrest("converge", "cornell-mirror", "--out", "b", "--resume")
        self.assertEqual(rows("b", scores), before)
        runs = [(scene, method, seed) for scene in ("cornell-diffuse", "cornell-mirror") for method in ("lt", "pt") for seed in (1, 2)]
        stored = "SELECT scene, method, seed FROM run ORDER BY scene, method, seed"
        self.assertEqual(rows("b", stored), runs)
        # Its first scene goes on with the reference of its runs, and with no other.
        self.run_wavecrest("reference", "cornell-diffuse", "--size", "32x24", "--spp", "2", "-o", "other.exr")
        reference, more = self.path("b/references/cornell-diffuse.exr"), ["converge", "--out", "b", "--resume", "--seeds", "3"]
        shutil.copyfile(self.path("other.exr"), reference)
        result = self.run_wavecrest(*more, expect=INPUT)
        self.assertRegex(result.stderr, r"error: b/references/cornell-diffuse\.exr: has other noise floors than")
        self.assertEqual(rows("b", stored), runs)
        shutil.copyfile(self.path("a/references/cornell-diffuse.exr"), reference)
        self.run_wavecrest(*more)
        self.assertEqual(len(rows("b", stored)), 12)

    def test_a_figure_is_repeated_by_all_rows(self):
        for name in ("bench", "scenes", "tools"):
            (self.folder / name).symlink_to(ROOT / name)
        # In place of a build and ten seconds a run: this program, with small and short runs.
        small = "(10s) word=0.3s ;; scenes/references/1024x768) word=small ;;"
        wrapper = f"""#!/bin/sh
for word; do
  case "$word" in {small} esac
  set -- "$@" "$word"
  shift
done
[ "$1" != converge ] || set -- "$@" --size 32x24
exec {WAVECREST} "$@"
"""
        self.write("wrapper", wrapper)
        stub = '#!/bin/sh\nmkdir -p build/quickstart && cp wrapper build/quickstart/wavecrest && chmod +x build/quickstart/wavecrest\n'
        pathlib.Path(self.write("quickstart", stub + 'echo "$@" > asked\n')).chmod(0o755)
        (self.folder / "small").mkdir()
        self.run_wavecrest("reference", "cornell-mirror", "--size", "32x24", "--time", "0.1s", "-o", "small/cornell-mirror.exr")
        result = subprocess.run(
            ["bench/campaign/repeat-figure"], cwd=self.folder, capture_output=True, text=True, timeout=TIMEOUT_SECONDS, check=False
        )
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.read("asked"), "--program-only\n")
        figure = self.read("out/repeat-figure/page/cornell-mirror.svg")
        self.assertEqual(figure.count("<polyline"), 13 * 3, "thirteen rows by three metrics")
        self.assertIn("<image", figure)
        self.assertIn("open out/repeat-figure/page/cornell-mirror.svg", result.stdout)
        self.assertIn("compare it with bench/campaign/study/cornell-mirror.svg", result.stdout)

    def test_a_readme_without_a_place_for_it_is_left_alone(self):
        self.campaign()
        result = self.publish("# A title\n")
        self.assertEqual(result.returncode, 1)
        self.assertIn("has no lines <!-- results -->", result.stderr)
        self.assertEqual(self.read("README.md"), "# A title\n")
        pathlib.Path(self.path("README.md")).unlink()
        result = self.publish(readme=None)
        self.assertRegex(result.stderr, r"^publish: README\.md does not exist; expected [^\n]*\n$")
        self.assertFalse(pathlib.Path(self.path("standard")).exists(), "nothing is written")


if __name__ == "__main__":
    unittest.main()
