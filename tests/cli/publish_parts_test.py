"""Parts of bench/campaign/publish and of what it draws with, without a campaign."""

import json
import re
import shlex
import subprocess
import sys
import types
import unittest

from publish_harness import CAMPAIGN, ROOT  # which makes the following be found

import curves
import scene_figure
import small_multiples
import svg_plot
from program_module import program_module


class PublishParts(unittest.TestCase):
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

    def test_a_score_that_none_reaches_has_the_time_at_which_the_first_one_would(self):
        publish = program_module("bench/campaign/publish")
        campaign = object.__new__(publish.Campaign)
        campaign.methods = ["pt", "bpt", "vcm"]
        ends = {"pt": 0.92, "bpt": 0.91, "vcm": 0.6}
        campaign.series = {("a", method, "ssim"): [[(0, 1.0, 0.5), (1, 10.0, end)]] for method, end in ends.items()}
        campaign.floors = {"a": {"ssim": 0.96}}

        def told(rows, target=0.95):
            cell, time = publish.first_or_closest(campaign, "a", "ssim", target, rows)
            self.assertEqual(time, "")
            return cell.removeprefix("– <sub>").removesuffix("</sub>") + publish.allowed(campaign, "a", "ssim", target)

        def times(near_floor, **ahead):
            keys = ("seconds_ahead", "low", "high")
            row = {"scene": "a", "metric": "ssim", "target": 0.95, "seconds": "", "at_most": "", "near_floor": near_floor}
            campaign.times = [row | {"method": m} | dict(zip(keys, ahead.get(m, ("", "", "")))) for m in campaign.methods]

        times("", pt=("123.4", "51.2", "1314"), bpt=("99.6", "40", ""))
        self.assertEqual(told(["pt"]), "pt 0.920; 120 s (51 to 1300)")
        self.assertEqual(told(["pt", "bpt"]), "pt 0.920; bpt 100 s (40 or longer)")
        self.assertEqual(told(["vcm"]), "vcm 0.600", "a curve that does not lead there")
        times("yes")
        self.assertEqual(told(["pt"]), "pt 0.920<br><sub>perfect image 0.960</sub>")

    def test_axes_of_time_have_round_labels(self):
        self.assertEqual(self.times_of(360.0), ["0 s", "100 s", "200 s", "300 s"])
        self.assertEqual(self.times_of(10.0), ["0 s", "5 s", "10 s"])

    def test_axes_of_log_time_have_ticks_and_labels_that_do_not_overlap(self):
        for times, labels in {(2.0, 8.0): ["2 s", "5 s"], (1.0, 30.0): ["1 s", "10 s"], (11.0, 990.0): ["20 s", "50 s", "200 s", "500 s"]}.items():
            series = [[(k, seconds, 0.5) for k, seconds in enumerate(times)]]
            campaign = types.SimpleNamespace(methods=["pt"], scenes=["a"], floors={}, series={("a", "pt", "rmse"): series})
            self.assertEqual(re.findall(r">([\d.]+ s)<", small_multiples.small_multiples(campaign, "rmse")), labels)

    def test_labels_at_the_pages_edge_are_whole(self):
        panel = svg_plot.Panel(58, 30, 882, 200, svg_plot.decade_axis(1.0, 100.0, unit=" s"), svg_plot.even_axis(0, 1, 5))
        drawn = "".join(panel.draw("a", {}))
        self.assertEqual(re.findall(r'<text x="([\d.]+)"[^>]* text-anchor="end">100 s<', drawn), [f"{svg_plot.WIDTH:.1f}"])

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

    def test_shares_of_cores_are_rounded_down(self):
        publish = program_module("bench/campaign/publish")
        settings = dict.fromkeys(("size", "time", "cpu", "isa", "precision", "sampler", "version", "commit"), "x") | {"seeds": "1"}

        def conditions(share, methods=("pt",)):
            runs = [("x", method, 1, {"threads": 2}) for method in methods]
            shares = [(*run[:3], share) for run in runs]
            return publish.conditions(types.SimpleNamespace(settings=settings, runs=runs, methods=methods, shares=lambda: shares))

        self.assertIn("for at least 94% of its time.", conditions(0.9451))
        self.assertIn("1 of 1 runs had less than 94% of their cores' time: x pt seed 1 (93%).", conditions(0.9399))
        # Errors of chains.
        header = (ROOT / "bench" / "statistics" / "chains_mislead.h").read_text(encoding="utf-8")
        self.assertIn(f'"{publish.CHAINS_MISLEAD}"', header)
        self.assertIn(f"kFewestChainRenders = {publish.FEWEST_CHAIN_RENDERS};", header)
        said = f" Of mlt: {publish.CHAINS_MISLEAD}."
        self.assertNotIn(said, conditions(1))
        self.assertTrue(conditions(1, ("pt", "mlt-pathspace")).endswith(said))

    def test_times_of_scenes_whose_names_have_blanks(self):
        publish = program_module("bench/campaign/publish")
        campaign = types.SimpleNamespace(settings={"time": "my room=720 cornell-diffuse=360"})
        self.assertEqual(publish.run_time(campaign), "720 s a run in my room, 360 s a run in cornell-diffuse")
        campaign.settings = {"time": "12"}
        self.assertEqual(publish.run_time(campaign), "12 s a run")

    def test_findings_are_counted_in_words_of_their_number(self):
        publish = program_module("bench/campaign/publish")
        verdicts = ["holds", "does not hold", "undecided", *3 * ["not reached in this time"]]

        def tally(times):
            return publish.tally(types.SimpleNamespace(claims=[{"verdict": verdict} for verdict in times * verdicts]))

        self.assertEqual(tally(1), "1 holds, 1 does not, 3 not in this time, 1 is undecided")
        self.assertEqual(tally(2), "2 hold, 2 do not, 6 not in this time, 2 are undecided")

    def test_references_are_estimated_by_seconds_above_0(self):
        program = CAMPAIGN / "remake-references"
        for seconds in ("0", "-1", "nan", "inf"):
            command = [sys.executable, program, f"--estimate={seconds}", "no-such-scene"]
            result = subprocess.run(command, check=False, capture_output=True, text=True)
            self.assertEqual(result.returncode, 2)
            self.assertIn(f"--estimate: '{seconds}'; expected seconds above 0\n", result.stderr)

    def test_long_times_are_no_powers_of_ten(self):
        publish = program_module("bench/campaign/publish")
        settings = {"time": "x=1440 y=2460 z=59.44", "size": "1x1", "seeds": "1"}
        runs = [("x", "pt", 1, {"threads": 2})]
        campaign = types.SimpleNamespace(settings=settings, runs=runs, scenes=[], claims=[])
        self.assertEqual(publish.run_time(campaign), "1440 s a run in x, 2460 s a run in y, 59.4 s a run in z")
        self.assertIn("1 seed, 59.4 to 2460 s a run;", " ".join(publish.section(campaign, "FOLDER").split()))

    def test_the_page_names_the_files_that_were_asked_for(self):
        publish = program_module("bench/campaign/publish")
        settings = {"profile": "study", "options": '{"scenes": ["x"], "--profile": ["study"]}', "commit": "0"}
        campaign = types.SimpleNamespace(settings=settings, own_references=False, runs=[("x", "pt", 1, {"threads": 2})])

        def words(folder, readme=None):
            return publish.commands(campaign, folder, readme)[-1].removeprefix("bench/campaign/publish DIR")

        self.assertEqual(words(CAMPAIGN / "standard"), "")
        self.assertEqual(words(CAMPAIGN / "another"), " --to bench/campaign/another")
        study = words(CAMPAIGN / "study", ROOT / "README.md")
        self.assertEqual(study, " --to bench/campaign/study --readme README.md")
        elsewhere = ROOT.parent / "elsewhere"
        self.assertEqual(words(elsewhere, elsewhere / "README.md"), " --to FOLDER --readme FILE")

    def test_the_command_of_a_campaign_is_what_a_shell_takes(self):
        publish = program_module("bench/campaign/publish")
        options = {"scenes": ["my/a b.xml"], "--crop": ["x:1,2,3x4", "x:5,6,7x8"], "--methods": ["pt", "lt"], "-D": ["n=1", "m=$2"]}
        settings = {"profile": "quick", "options": json.dumps(options), "commit": "0"}
        campaign = types.SimpleNamespace(settings=settings, own_references=False, runs=[("x", "pt", 1, {"threads": 2})])
        *_, converge, _ = publish.commands(campaign, CAMPAIGN / "standard", None)
        words = ["wavecrest", "converge", "my/a b.xml", "--crop", "x:1,2,3x4", "--crop", "x:5,6,7x8", "--methods", "pt,lt"]
        self.assertEqual(shlex.split(converge), [*words, "-D", "n=1", "-D", "m=$2", "--threads", "2", "--out", "DIR"])
        self.assertIn(" 'm=$2' ", converge)

    def test_references_that_the_repository_lacks_are_not_said_to_be_checked(self):
        publish = program_module("bench/campaign/publish")
        stats = {"asked_seconds": 9.0, "threads": 2}

        def notes(scenes, own=False):
            settings = {"size": "1024x768", "clock": "cpu", "seeds": "2"}
            campaign = types.SimpleNamespace(scenes=scenes, settings=settings, own_references=own, runs=[("x", "pt", 1, stats)])
            return publish.study_notes(campaign)

        self.assertIn("stands in the evidence of each finding about one scene (", notes(["cornell-diffuse"]))
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


if __name__ == "__main__":
    unittest.main()
