"""wavecrest bench: every method is measured, and its stages take up its time."""

import json
import os
import pathlib
import subprocess
import sys
import unittest

import jsonschema

from harness import CHECK, DONE, FAILURE, INPUT, USAGE, WAVECREST, CommandTest, read_json
from results_schema import validate

EXPORT = pathlib.Path(__file__).parents[2] / "bench" / "integrations" / "export_results.py"


# Stages that must be among those of a method: of both passes, and of what is built between them.
STAGES = {
    "pt": ["extend", "next event"],
    "lt": ["extend light", "connect to camera", "scatter specular"],
    "bpt": ["store", "connect", "occlude connection"],
    "mlt": ["extend"],
    "ppm": ["store", "photon map", "merge"],
    "bpm": ["store", "photon map", "merge"],
    "vcm": ["store", "photon map", "connect", "merge"],
    "gpt": ["extend", "find cells", "next event"],
}


class Bench(CommandTest):
    def test_the_stages_of_every_method_take_up_its_time(self):
        output = self.path("bench.json")
        told = self.run_wavecrest(
            "bench", "cornell-diffuse", "--methods", ",".join(STAGES), "--size", "24x16",
            "--duration", "0.2s", "--threads", "1", "--json", output, expect=DONE,
        )
        self.assertNotRegex(told.stdout, r"\b(inf|nan)\b")
        result = read_json(output)
        validate(result)
        methods = result["scenes"][0]["methods"]
        self.assertEqual([entry["method"] for entry in methods], list(STAGES))
        for entry in methods:
            shares = {stage["name"]: stage["share"] for stage in entry["stages"]}
            for name in STAGES[entry["method"]]:
                self.assertGreater(shares[name], 0, f"{entry['method']}: {name}")
            for stage in entry["stages"]:
                if stage["name"] in ("photon map", "direct pass"):  # not made of lanes
                    self.assertIsNone(stage["lane_use"])
                elif stage["items_per_path"] > 0:
                    self.assertTrue(0 < stage["lane_use"] <= 1, f"{entry['method']}: {stage}")
            # Medians over slices, of which each is below 1 in sum.
            self.assertLess(sum(shares.values()), 1.05, entry["method"])
            for name in ("paths_per_second", "paths_per_cpu_second", "rays_per_second"):
                low, high = entry[name + "_interval"]
                self.assertTrue(0 < low <= entry[name] <= high, f"{entry['method']}: {name}")
            self.assertEqual("bare_embree" in entry, entry["method"] in ("pt", "gpt"), entry["method"])
            for rates in (entry["bare_embree"][kind] for kind in ("closest", "any_hit") if "bare_embree" in entry):
                self.assertGreater(rates["bare_rays_per_second"], 0)
                self.assertGreater(rates["bare_not_robust_rays_per_second"], 0)

    def test_a_stored_result_equals_itself_and_is_slower_than_a_faster_one(self):
        before = self.path("before.json")
        self.run_wavecrest("bench", "cornell-diffuse", "--methods", "lt", "--size", "16x16", "--duration", "0.5s",
                           "--threads", "1", "--json", before)
        told = self.run_wavecrest("bench", "--compare", before, before, "--json", "-")
        validate(json.loads(told.stdout))
        faster = read_json(before)
        for slice_ in faster["scenes"][0]["methods"][0]["scaling"][0]["slices"]:
            slice_["cpu_seconds"] /= 10
        faster_file = self.write("faster.json", json.dumps(faster))
        self.run_wavecrest("bench", "--compare", before, faster_file, expect=DONE)
        self.run_wavecrest("bench", "--compare", faster_file, before, expect=CHECK)
        faster["machine"]["cpu"] = "another"
        other = self.write("other.json", json.dumps(faster))
        result = self.run_wavecrest("bench", "--compare", before, other, expect=INPUT)
        self.assert_one_error_line(result, ".*come from different machines")

    def test_a_result_is_exported_for_other_tools(self):
        result = self.path("result.json")
        self.run_wavecrest("bench", "cornell-diffuse", "--methods", "vcm", "--size", "16x16", "--duration", "0.5s",
                           "--threads", "1", "--json", result)
        method = read_json(result)["scenes"][0]["methods"][0]

        def exported(kind):
            told = subprocess.run([sys.executable, EXPORT, kind, result], capture_output=True, text=True, check=True)
            return json.loads(told.stdout)

        repetitions = exported("google-benchmark")["benchmarks"]
        self.assertEqual(len(repetitions), len(method["scaling"][0]["slices"]))
        rates = sorted(one["items_per_second"] for one in repetitions)
        self.assertTrue(rates[0] <= method["paths_per_cpu_second"] <= rates[-1])
        self.assertEqual(repetitions[0]["run_name"], "cornell-diffuse/vcm")
        measures = exported("bencher")
        rate = measures["cornell-diffuse/vcm"]["paths-per-cpu-second"]
        self.assertTrue(rate["lower_value"] <= rate["value"] == method["paths_per_cpu_second"] <= rate["upper_value"])
        merging = sum(stage["seconds_per_path"] for stage in method["stages"] if stage["name"] == "merge")
        self.assertAlmostEqual(measures["cornell-diffuse/vcm/merge"]["nanoseconds-per-path"]["value"], 1e9 * merging)

    def test_the_schema_refuses_what_it_does_not_describe(self):
        with self.assertRaises(jsonschema.ValidationError):
            validate({"schema_version": 1, "kind": "throughput"})


class Scaling(CommandTest):
    def test_measures_what_this_machine_has_and_predicts_the_rest(self):
        # Processes render what this command says, whatever variables say.
        told = self.run_wavecrest("bench", "cornell-diffuse", "--scaling", "--methods", "pt,vcm", "--size", "48x32",
                                  "--threads", "2", "--duration", "0.2s", "--json", self.path("scaling.json"),
                                  variables={"WAVECREST_SAMPLER": "moon"})
        self.assertRegex(told.stdout, r"predicted")
        result = read_json(self.path("scaling.json"))
        validate(result)
        self.assertEqual([row["method"] for row in result["results"]], ["pt", "vcm"])
        for row in result["results"]:
            self.assertEqual([measured["threads"] for measured in row["measured"]], [1, 2])
            self.assertEqual([predicted["threads"] for predicted in row["predicted"]], [2**k for k in range(1, 9)])
            self.assertEqual([parts["machines"] for parts in row["parts"]], [2**k for k in range(1, 7)])
            # Three sums and a count of samples for each of 48x32 pixels; vcm also three sums of splats.
            least = 48 * 32 * (32 if row["method"] == "pt" else 80)
            self.assertGreater(row["parts"][0]["snapshot_bytes"], 2 * least)
            self.assertLess(row["parts"][0]["snapshot_bytes"], 2 * (least + 10000))
            self.assertEqual(row["measured"][0]["speedup"], 1)
            for predicted in row["predicted"]:
                # How large is for the tests of bench/scaling, whose tasks take made-up times: those here depend on the machine.
                self.assertGreater(predicted["speedup"], 0, row["method"])
                self.assertGreater(predicted["parallelism"], 1, row["method"])

    def test_parts_of_mlt_share_the_chains(self):
        self.run_wavecrest("bench", "cornell-diffuse", "--scaling", "--methods", "mlt", "--size", "24x16", "--threads", "1",
                           "--duration", "0.2s", "--json", self.path("scaling.json"))
        row, = read_json(self.path("scaling.json"))["results"]
        first, last = row["parts"][0], row["parts"][-1]
        self.assertLess(last["snapshot_bytes"], last["machines"] // first["machines"] * first["snapshot_bytes"])


class Tradeoff(CommandTest):
    def test_every_setting_has_its_figures_or_its_refusal(self):
        told = self.run_wavecrest("bench", "cornell-diffuse", "--tradeoff", "--methods", "vcm,mlt", "--size", "32x24", "--seeds",
                                  "4", "--duration", "0.2s", "--json", self.path("trade.json"), "--html", self.path("t.html"))
        self.assertRegex(told.stdout, r"--radius-alpha 0\.5")
        result = read_json(self.path("trade.json"))
        validate(result)
        self.assertEqual([entry["method"] for entry in result["results"]], ["vcm", "mlt"])
        page = (self.folder / "t.html").read_text()
        for entry in result["results"]:
            self.assertIn(f"{entry['scene']}, {entry['method']}", page)
            self.assertGreater(len(entry["rows"]), 15)

    def test_settings_can_be_chosen(self):
        self.run_wavecrest("bench", "cornell-diffuse", "--tradeoff", "--methods", "pt", "--size", "32x24", "--seeds", "4",
                           "--duration", "0.2s", "--knobs", "precision,--accel", "--json", self.path("trade.json"))
        result = read_json(self.path("trade.json"))
        validate(result)
        entry, = result["results"]
        self.assertEqual(entry["seeds"], 4)
        self.assertEqual({row["knob"] for row in entry["rows"]}, {"baseline", "--precision", "--accel"})
        refused = self.run_wavecrest("bench", "cornell-diffuse", "--tradeoff", "--methods", "pt", "--knobs", "radius",
                                     "--size", "32x24", expect=USAGE)
        self.assert_one_error_line(refused, "--knobs: 'radius' is no setting that is varied here")
        unknown = self.run_wavecrest("bench", "cornell-diffuse", "--tradeoff", "--methods", "pt,mlt", "--knobs", "sampler,radius",
                                     "--size", "8x8", expect=USAGE)
        self.assert_one_error_line(unknown, "--knobs: 'radius' is no setting that is varied here")
        self.assertEqual(unknown.stdout, "", "nothing is measured")
        alone = self.run_wavecrest("bench", "cornell-diffuse", "--seeds", "4", expect=USAGE)
        self.assert_one_error_line(alone, "--seeds goes with --tradeoff; expected it")

    def test_a_method_without_a_chosen_setting_has_the_compared_ones(self):
        self.run_wavecrest("bench", "cornell-diffuse", "--tradeoff", "--methods", "pt,mlt", "--knobs", "sampler", "--size", "8x8",
                           "--duration", "0.1s", "--seeds", "2", "--json", self.path("trade.json"))
        result = read_json(self.path("trade.json"))
        validate(result)
        compared = ["baseline", "--precision"]
        self.assertEqual([[row["knob"] for row in entry["rows"]] for entry in result["results"]],
                         [[*compared, "--sampler"], compared])

    def test_a_page_is_alone_on_stdout(self):
        told = self.run_wavecrest("bench", "cornell-diffuse", "--tradeoff", "--methods", "pt", "--size", "32x24", "--seeds",
                                  "2", "--duration", "0.1s", "--knobs", "precision", "--html", "-")
        self.assertTrue(told.stdout.startswith("<!DOCTYPE html>"), told.stdout[:80])
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_a_page_of_nothing_is_refused(self):
        result = self.run_wavecrest("bench", "cornell-diffuse", "--html", self.path("t.html"), expect=USAGE)
        self.assert_one_error_line(result, "--html goes with")


class Score(CommandTest):
    """A part of the small workload, validated by hashes that this build has just written."""

    PART = ("bench", "cornell-diffuse", "--score", "small", "--methods", "lt,vcm")
    written = None  # the hashes of this build, once a test has asked for them

    def hashes(self):
        """Leaves hashes.json, and returns what it holds."""
        if Score.written is None:
            self.run_wavecrest(*self.PART, "--write-hashes", self.path("written.json"))
            Score.written = pathlib.Path(self.path("written.json")).read_text()
        self.write("hashes.json", Score.written)
        return json.loads(Score.written)

    def has_all_figures(self, entry, events):
        self.assertEqual([round(at["samples_per_pixel"] * 8 / entry["iterations"]) for at in entry["quality"]],
                         [1, 2, 4, 8])
        self.assertLess(entry["quality"][-1]["relmse"], entry["quality"][0]["relmse"])
        used = [stage for stage in entry["stages"] if stage["items_per_path"] > 0]
        for name in STAGES[entry["method"]]:
            self.assertIn(name, [stage["name"] for stage in used])
        self.assertTrue(all(stage["seconds_per_item"] > 0 for stage in used))
        self.assertTrue(any(stage["bytes_per_item"] for stage in used))
        if events:
            self.assertTrue(any(stage["events_per_item"]["cycles"] > 0 for stage in used))

    def is_exported_for_other_tools(self, result):
        result["valid"] = False
        self.write("score.json", json.dumps(result))

        def exported(kind):
            return subprocess.run([sys.executable, EXPORT, kind, self.path("score.json")], capture_output=True,
                                  text=True)

        self.assertIn("not valid", exported("bencher").stderr)
        result["valid"] = True
        self.write("score.json", json.dumps(result))
        measures = json.loads(exported("bencher").stdout)
        self.assertEqual(measures["score/small"]["score"]["value"], result["score"])
        self.assertEqual(measures["score/small/vcm"]["score"]["value"], result["method_scores"]["vcm"])
        entry = result["entries"][1]
        self.assertEqual(measures["cornell-diffuse/vcm"]["paths-per-cpu-second"]["value"],
                         entry["paths_per_cpu_second"])
        benchmarks = {one["name"]: one for one in json.loads(exported("google-benchmark").stdout)["benchmarks"]}
        self.assertEqual(benchmarks["cornell-diffuse/vcm"]["items_per_second"], entry["paths_per_cpu_second"])

    def test_hashes_of_another_build_lead_to_pictures(self):
        hashes = self.hashes()
        for group in hashes["images"]["small"]:
            hashes["images"]["small"][group]["cornell-diffuse"]["vcm"] = "0123456789abcdef"
            hashes["builds"]["small"][group] = "0.0.9, a compiler"
        other = self.write("other.json", json.dumps(hashes))
        told = self.run_wavecrest(*self.PART, "--hashes", other, "--json", self.path("score.json"), expect=DONE)
        self.assertRegex(told.stdout, r"(?m)^cornell-diffuse +vcm +within tolerance .*\n"
                                      r" +within tolerance \(worst block: SSIM \S+, mean off by \S+ %; image: ")
        self.assertIn("images: 1 exact, 1 within tolerance", told.stdout)
        self.assertNotIn("NOT VALID", told.stdout)
        self.assertNotRegex(told.stdout, r"\b(inf|nan)\b")
        result = read_json(self.path("score.json"))
        validate(result)
        self.assertTrue(result["valid"])
        if result["events_refusal"] is not None:
            self.assertIn("are not counted here", told.stdout)
        for entry in result["entries"]:
            self.has_all_figures(entry, result["events_refusal"] is None)
        exact, entry = result["entries"]
        self.assertAlmostEqual(result["score"] / (exact["score"] * entry["score"]) ** 0.5, 1)
        self.assertEqual((exact["method"], exact["image"], exact["image_verdict"]), ("lt", "exact", "exact"))
        self.assertIsNone(exact["image_difference"])
        self.assertEqual((entry["method"], entry["image"]), ("vcm", "within tolerance"))
        self.assertIn(entry["image_verdict"], told.stdout)
        self.assertGreater(entry["image_difference"]["ssim"], 0.995)
        self.assertLess(entry["image_difference"]["mean_off"], 0.003)
        self.is_exported_for_other_tools(result)

    def test_other_bits_of_this_build_and_another_picture_are_refused(self):
        hashes = self.hashes()
        for group in hashes["images"]["small"].values():
            group["cornell-diffuse"] = {"lt": "0123456789abcdef"}
        wrong = self.write("wrong.json", json.dumps(hashes))
        self.run_wavecrest(*self.PART, "--write-pictures", self.path("pictures.json"))
        pictures = read_json(self.path("pictures.json"))
        images = pictures["pictures"]["small"]["cornell-diffuse"]
        images["vcm"] = images["lt"]
        swapped = self.write("swapped.json", json.dumps(pictures))
        told = self.run_wavecrest(*self.PART, "--hashes", wrong, "--pictures", swapped, "--json",
                                  self.path("score.json"), expect=CHECK)
        self.assertRegex(told.stdout, r"(?m)^cornell-diffuse +lt +refused .*\n +refused \(other bits than")
        self.assertRegex(told.stdout, r"(?m)^ +refused \(.*image: SSIM \S+, at least 0.995")
        self.assertIn("NOT VALID", told.stdout)
        result = read_json(self.path("score.json"))
        validate(result)
        self.assertFalse(result["valid"])
        self.assertEqual([entry["image"] for entry in result["entries"]], ["refused", "refused"])

    def test_without_hash_and_picture_there_is_no_valid_score(self):
        no_hashes = self.write("hashes.json", json.dumps({"score_version": 1, "images": {}}))
        no_pictures = self.write("pictures.json", json.dumps({"score_version": 1, "pictures": {}}))
        told = self.run_wavecrest("bench", "cornell-diffuse", "--score", "small", "--methods", "lt", "--hashes",
                                  no_hashes, "--pictures", no_pictures, expect=CHECK)
        self.assertRegex(told.stdout, r"(?m)^cornell-diffuse +lt +unknown")
        self.assertIn("could not be validated", told.stdout)

    def test_hashes_of_other_sizes_and_instruction_sets_stay(self):
        kept = {"large": {"avx9": {"a-scene": {"pt": "00000000000000ff"}}}}
        self.write("hashes.json", json.dumps({"score_version": 1, "images": kept}))
        self.run_wavecrest(*self.PART, "--write-hashes", self.path("hashes.json"))
        images = read_json(self.path("hashes.json"))["images"]
        self.assertEqual(images["large"], kept["large"])
        self.assertIn("small", images)

    def test_what_no_score_is_made_of_is_refused(self):
        result = self.run_wavecrest("bench", "veach-door", "--score", "small", expect=USAGE)
        self.assert_one_error_line(result, "--score small: has no scene veach-door")
        result = self.run_wavecrest("bench", "--score", "tiny", expect=USAGE)
        self.assert_one_error_line(result, "--score")
        result = self.run_wavecrest("bench", "--score", "small", "--size", "8x8", expect=USAGE)
        self.assert_one_error_line(result, "--score has sizes")
        result = self.run_wavecrest("bench", "--hashes", "x.json", expect=USAGE)
        self.assert_one_error_line(result, "--hashes")
        result = self.run_wavecrest("bench", "--score", "small", "--hashes", self.write("bad.json", "[]"), expect=INPUT)
        self.assert_one_error_line(result, ".*bad.json: has no hashes")
        result = self.run_wavecrest("bench", "--score", "small", "--pictures", self.path("bad.json"), expect=INPUT)
        self.assert_one_error_line(result, ".*bad.json: has no pictures")


class Phoronix(CommandTest):
    def test_its_suite_is_told_how_the_installation_ended(self):
        (self.folder / "bin").mkdir()
        pathlib.Path(self.write("bin/cmake", '#!/bin/sh\nexit "$ENDS"\n')).chmod(0o755)
        for source, status in (("", 2), ("sources", 3), ("sources", 0)):
            environment = os.environ | {
                "HOME": str(self.folder), "PATH": f"{self.folder}/bin:{os.environ['PATH']}", "WAVECREST_SOURCE": source, "ENDS": str(status),
            }  # fmt: skip
            script = EXPORT.parent / "phoronix" / "install.sh"
            done = subprocess.run(["sh", script], cwd=self.folder, env=environment, capture_output=True, check=False)
            self.assertEqual(done.returncode, status)
            self.assertEqual(pathlib.Path(self.path("install-exit-status")).read_text(), f"{status}\n")


class Specialization(CommandTest):
    def test_says_what_a_scene_pays_for(self):
        told = self.run_wavecrest("bench", "cornell-diffuse", "cornell-mirror", "--specialization", "--methods", "pt",
                                  "--size", "32x24", "--duration", "0.2s", "--json", self.path("sets.json"), expect=DONE)
        self.assertRegex(told.stdout, r"cornell-mirror pt 32x24: needs specular BSDFs")
        result = read_json(self.path("sets.json"))
        validate(result)
        for entry in result["results"]:
            self.assertEqual(len([row for row in entry["rows"] if row["chosen"]]), 1)
            self.assertEqual(entry["rows"][-1]["kernels"], "complete")
            self.assertFalse(any(row["differs"] for row in entry["rows"]))


class Modes(CommandTest):
    def test_what_a_mode_would_ignore_is_refused(self):
        for arguments, answer in [
            (["--extremes", "--scaling"], r"--scaling and --extremes: two modes; expected one of them$"),
            (["--tradeoff", "--compare", "a.json", "b.json"], r"--compare and --tradeoff: two modes"),
            (["--score", "small", "--against", WAVECREST], r"--against and --score: two modes"),
            (["--family-level", "0.1"], r"--family-level goes with --against or --compare; expected one of them$"),
            (["--tolerance", "0.1", "--scaling"], r"--tolerance goes with --against or --compare"),
            (["--extremes", "--knobs", "precision"], r"--knobs goes with --tradeoff; expected it$"),
            (["--scaling", "--write-hashes", "h.json"], r"--write-hashes goes with --score; expected it$"),
            (["--pictures", "p.json"], r"--pictures goes with --score; expected it$"),
            (["--scaling", "--pin"], r"--pin goes with none"),
            (["--score", "small", "--write-hashes", "h.json", "--json", "j.json"], r"--write-hashes measures nothing"),
            (["--score", "small", "--write-pictures", "p.json", "--hashes", __file__],
             r"--write-pictures measures nothing"),
            (["--score", "small", "--write-hashes", "-"], r"--write-hashes -: expected a file$"),
            (["cornell-diffuse", "--compare", "a.json", "b.json"], r"--compare measures nothing; expected no scenes"),
            (["--size", "8x8", "--compare", "a.json", "b.json"], r"--compare measures nothing; expected no scenes"),
            (["--threads", "1", "--compare", "a.json", "b.json"], r"--compare measures nothing; expected no scenes"),
            (["--threads", "1", "--machines", "m.json"], r"--machines measures nothing; expected no scenes"),
            (["-", "--against", WAVECREST], r"--against: other processes cannot read the scene from stdin"),
            (["-", "--scaling"], r"--scaling: other processes cannot read the scene from stdin"),
            (["--specialization", "--threads", "2"], r"--specialization renders on one thread; expected no --threads$"),
            (["--extremes", "--duration", "1s"], r"--extremes has scenes, methods, sizes and lengths of its own"),
        ]:
            with self.subTest(arguments):
                self.assert_one_error_line(self.run_wavecrest("bench", *arguments, expect=USAGE), answer)

    def test_variables_are_defaults_that_contradict_no_mode(self):
        variables = {"WAVECREST_SIZE": "8x8", "WAVECREST_THREADS": "2"}
        for arguments, answer in [
            (["--score", "tiny"], r"--score tiny: unknown"),  # which comes after the size
            (["--machines", "none.json"], r".*none\.json: cannot be read"),
            (["--compare", "a.json", "b.json"], r".*[ab]\.json: cannot be read"),
            (["none.xml", "--specialization"], r".*none\.xml: no such file"),
        ]:
            for threads in ("2", "04", "+4"):
                with self.subTest(arguments, threads=threads):
                    result = self.run_wavecrest("bench", *arguments, expect=None,
                                                variables=variables | {"WAVECREST_THREADS": threads})  # fmt: skip
                    self.assert_one_error_line(result, answer)
        typed = self.run_wavecrest("bench", "--score", "tiny", "--size", "8x8", expect=USAGE, variables=variables)
        self.assert_one_error_line(typed, "--score has sizes")

    def test_folders_of_processes_are_checked_before_anything_is_measured(self):
        for arguments in (["--score", "small", "--methods", "lt"], ["--scaling", "--methods", "pt", "--size", "16x16"]):
            with self.subTest(arguments):
                result = self.run_wavecrest("bench", "cornell-diffuse", *arguments, expect=FAILURE,
                                            variables={"TMPDIR": "/proc"})  # fmt: skip
                self.assert_one_error_line(result, r"/proc/wavecrest_\w+: ")
                self.assertEqual(result.stdout, "")

    def test_files_are_checked_before_anything_is_measured(self):
        for arguments, answer in [
            (["--json", "absent/b.json"], r"--json absent/b\.json: there is no folder"),
            (["--extremes", "--html", "absent/p.html"], r"--html absent/p\.html: there is no folder"),
            (["--against", "X", "--json", "X"], r"--json X: is the file of --against too"),
            (["--extremes", "--html", "-", "--json", "-"], r"--html -: is the file of --json too"),
            (["--score", "small", "--write-hashes", "absent/h.json"], r"--write-hashes absent/h\.json: there is no"),
        ]:
            with self.subTest(arguments):
                self.assert_one_error_line(self.run_wavecrest("bench", *arguments, expect=USAGE), answer)


if __name__ == "__main__":
    unittest.main()
