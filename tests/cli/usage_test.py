"""Options: what is wrong on the command line ends with exit code 2 before anything is rendered."""

import json
import os
import pathlib
import subprocess
import sys
import unittest

from harness import DONE, INPUT, USAGE, CommandTest, read_json


class Usage(CommandTest):
    def test_help_and_version_are_no_errors(self):
        for arguments in (["--help"], ["render", "--help"], ["--version"]):
            self.assertNotEqual(self.run_wavecrest(*arguments, expect=DONE).stdout, "")

    def test_a_subcommand_is_required(self):
        self.run_wavecrest(expect=USAGE)
        self.run_wavecrest("rendr", "cornell-diffuse", expect=USAGE)

    def test_a_scene_is_required(self):
        self.run_wavecrest("render", expect=USAGE)

    def test_unknown_options_are_refused(self):
        for option in ("--no-such-option", "--sp", "-z"):
            result = self.render(option, expect=USAGE)
            self.assertIn(option, result.stderr)

    def test_values_that_make_no_sense_are_refused(self):
        for option, value in [
            ("--size", "32"),
            ("--size", "0x24"),
            ("--size", "32x24x3"),
            ("--size", "-32x24"),
            ("--size", "70000x2"),
            ("--time", "soon"),
            ("--time", "-1s"),
            ("--time", "0s"),
            ("--time", "5 s"),
            ("--time", "nan"),
            ("--time", "1d"),
            ("--spp", "0"),
            ("--spp", "-3"),
            ("--spp", "many"),
            ("--threads", "0"),
            ("--seed", "-1"),
            ("--seed", "x"),
            ("--wave", "1"),
            ("--rr-depth", "0"),
            ("--max-depth", "deep"),
            ("--max-depth", "-2"),
            ("--max-depth", "0"),
            ("--max-depth", "5000"),
            ("--snapshot-every", "never"),
            ("--snapshot-every", "1e-9s"),
            ("-D", "albedo"),
            ("-D", "=0.5"),
            ("--method", "photons"),
            ("--sampler", "halton"),
            ("--precision", "half"),
            ("--isa", "neon"),
            ("--accel", "kd"),
            ("--progress", "loud"),
            ("--radius", "-1"),
            ("--radius", "nan"),
            ("--memory", "lots"),
            ("--memory", "12"),
            ("--memory", "-3G"),
            ("--memory", "1GX"),
            ("--memory", "nanG"),
            ("--radius-alpha", "2"),
            ("--radius-alpha", "nan"),
            ("--mlt", "metropolis"),
            ("--chains", "0"),
            ("--bootstrap", "none"),
            ("--restart", "0"),
        ]:
            with self.subTest(option=option, value=value):
                wrong = f"{option}={value}" if option.startswith("--") else f"{option}{value}"
                small = ["-D", "width=8", "-D", "height=8", "-D", "spp=1"]  # ends soon if it is not refused
                result = self.run_wavecrest(
                    "render", "cornell-diffuse", *small, "-o", self.path("image.exr"), wrong, expect=USAGE
                )
                self.assertNotEqual(result.stderr, "")
                self.assertFalse((self.folder / "image.exr").exists())

    def test_options_of_other_methods_are_refused(self):
        no_chains = r"pt has no Markov chains; expected mlt$"
        for arguments, answer in [
            (["--radius", "0.2"], r"--radius: pt does not merge; expected ppm, bpm, vcm or evcm$"),
            (["-m", "lt", "--radius-alpha", "0.1"], r"--radius-alpha: lt does not merge; expected ppm, bpm, vcm or evcm$"),
            (["--light-paths", "9"], r"--light-paths: pt traces no photons to merge with; expected ppm, bpm, vcm or evcm$"),
            (["-m", "lt", "--light-paths", "9"], r"--light-paths: lt traces no photons to merge with; expected ppm, bpm, vcm or evcm$"),
            (["-m", "vcm", "--direct-pass"], r"--direct-pass: vcm has no such choice; expected ppm$"),
            (["-m", "ppm", "--merge-vertices", "all"], r"--merge-vertices: ppm has no choice of .*; expected vcm or evcm$"),
            (["-m", "vcm", "--merge-vertices", "none"], r"--merge-vertices none: unknown; expected one of all, first"),
            (["-m", "mlt", "--connection-roulette", "5"], r"--connection-roulette: mlt .*; expected bpt, vcm or evcm$"),
            (["-m", "mlt", "--roulette", "albedo"], r"--roulette: mlt has no such choice; expected pt, lt, .* or evcm$"),
            (["-m", "mlt", "--rr-depth", "3"], r"--rr-depth: mmlt ends no walk by roulette; expected --mlt pssmlt$"),
            (["--guide", "off"], r"--guide: pt learns no guide; expected gpt$"),
            (["-m", "vcm", "--guide-memory", "8MiB"], r"--guide-memory: vcm learns no guide; expected gpt$"),
            (["-m", "gpt", "--guide", "light"], r"--guide light: unknown; expected one of auto, radiance, variance, off$"),
            (["-m", "gpt", "--guide", "off", "--guide-memory", "8MiB"], r"--guide-memory: --guide off learns no guide; expected"),
            (["-m", "gpt", "--spp", "8", "--part", "1/2", "--checkpoint", "c"], r"--part: gpt .*; expected another method, or"),
            (["--mlt", "pathspace"], "--mlt: " + no_chains),
            (["--chains", "3"], "--chains: " + no_chains),
            (["--bootstrap", "5"], "--bootstrap: " + no_chains),
            (["--restart", "3"], "--restart: " + no_chains),
            (["--no-direct-pass"], "--no-direct-pass: " + no_chains),
            (["-m", "mlt", "--mlt", "pssmlt", "--no-direct-pass"], r"--no-direct-pass: pssmlt .*; expected --mlt mmlt or"),
            (["-m", "mlt", "--no-direct-pass", "--sampler", "sobol"], r"--sampler sobol: .*; expected independent$"),
            (["-m", "mlt", "--no-direct-pass", "--filter-mode", "sample"], r"--filter-mode sample: .*; expected spread$"),
            (["-m", "mlt", "--mlt", "pssmlt", "--filter-mode", "sample"], r"--filter-mode sample: .*; expected spread$"),
        ]:
            with self.subTest(arguments):
                self.assert_one_error_line(self.render("--dry-run", *arguments, expect=USAGE), answer)
        # Defaults fit every method, and the direct pass of mlt has a sampler and a filter mode.
        self.render("--dry-run", "--radius", "auto", "--chains", "16384", "--connection-roulette", "0.2", "--mlt", "mmlt")
        self.render("--dry-run", "-m", "mlt", "--sampler", "sobol", "--filter-mode", "sample")
        self.render("--dry-run", "-m", "gpt", "--guide", "off", "--spp", "8", "--part", "1/2", "--checkpoint", "c")

    def test_a_scene_may_follow_a_list_of_methods(self):
        for command, *more in (["converge", "--out", "a", "--progress", "none"], ["bench"], ["recommend"]):
            result = self.run_wavecrest(command, *more, "--methods", "pt,lt", "nowhere.xml", expect=INPUT)
            self.assert_one_error_line(result, r".*nowhere\.xml: no such file")

    def test_a_missing_folder_of_scenes_is_told(self):
        for arguments in (["inspect", "cornell-diffuse"], ["scenes", "--json"]):
            result = self.run_wavecrest(*arguments, expect=INPUT, variables={"WAVECREST_SCENES": "/nowhere"})
            self.assert_one_error_line(result, r"WAVECREST_SCENES is '/nowhere'; expected a folder of scenes")

    def test_words_of_a_list_name_the_choices(self):
        for word in ("half", "fast"):
            self.assertRegex(self.render("--precision", word, expect=USAGE).stderr, r"float, double\b(?!, )")
        self.assertIn("auto, embree, small", self.render("--accel", "kd", expect=USAGE).stderr)

    def test_numbers_that_an_option_does_not_take_are_answered_with_those_that_it_takes(self):
        for option, value, answer in [
            ("--spp", "x", "'x' is no whole number; expected 1 or more"),
            ("--spp", "0", "'0' is out of range; expected 1 or more"),
            ("--spp", "1.5", "'1.5' is no whole number; expected 1 or more"),
            ("--spp", "0x10", "'0x10' is no whole number; expected 1 or more"),
            ("--seed", "x", "'x' is no whole number; expected 0 to 18446744073709551615"),
            ("--seed", "-1", "'-1' is out of range; expected 0 to 18446744073709551615"),
            ("--seed", "18446744073709551616", "out of range; expected 0 to 18446744073709551615"),
            ("--threads", "4097", "'4097' is out of range; expected 1 to 4096"),
            ("--max-depth", "-2", "'-2' is out of range; expected 1 to 4095, or -1"),
            ("--rr-depth", "3000000000", "'3000000000' is out of range; expected 1 to 2147483647"),
            ("--radius", "nan", "'nan' is no number; expected 1e-06 to 10, or auto"),
            ("--radius", "1e999", "'1e999' is out of range; expected 1e-06 to 10, or auto"),
            ("--radius-alpha", "1.5", "'1.5' is out of range; expected 0 to 1"),
        ]:
            with self.subTest(option=option, value=value):
                result = self.render(f"{option}={value}", "--spp=1", expect=USAGE)
                self.assert_one_error_line(result, f"{option}: .*{answer}; see `wavecrest render --help`$")
        # A reference's halves differ in the high word of their seeds.
        result = self.run_wavecrest("reference", "cornell-diffuse", "--seed", "4294967296", expect=USAGE)
        self.assert_one_error_line(result, "--seed: .*expected 0 to 4294967295;")

    def test_numbers_are_decimal_and_may_be_the_largest(self):
        for word, seed in (("010", 10), ("000", 0), ("+7", 7), ("18446744073709551615", 2**64 - 1)):
            result = self.render("--spp=1", "--seed", word, "--stats=-")
            self.assertEqual(json.loads(result.stdout)["seed"], seed)
        self.render("--spp=1", "--max-depth=-1")

    def test_ten_mistakes_are_each_answered_with_a_useful_line(self):
        for arguments, code, answer in [
            (["rendr", "cornell-diffuse"], USAGE, r"unknown command 'rendr'; expected .*; did you mean 'render'\?"),
            (["help", "rendr"], USAGE, r"unknown command 'rendr'; expected .*; did you mean 'render'\?"),
            (["help", "nothing"], USAGE, r"unknown command 'nothing'; expected one of help, compare, converge,"),
            (["help", "render", "scenes"], USAGE, r"help render scenes: expected one command"),
            (["render", "cornell-difuse"], INPUT, r"cornell-difuse: no such file.*; did you mean 'cornell-diffuse'\?"),
            (["inspect", "nothing"], INPUT, r"nothing: no such file; expected .* that `wavecrest scenes` lists"),
            (["render", "absent.xml"], INPUT, r"absent\.xml: no such file; expected a Mitsuba scene file$"),
            (["render", "cornell-diffuse", "--smaples", "4"], USAGE, r"unknown argument '--smaples'"),
            (["render", "cornell-diffuse", "--thread=4"], USAGE, r"'--thread=4'; did you mean '--threads'\?"),
            (["render", "cornell-diffuse", "-m", "bdt"], USAGE, r"--method bdt: .*did you mean 'bpt'\?"),
            (["render", "cornell-diffuse", "--sampler", "soblo"], USAGE, r"independent, sobol; did you mean 'sobol'\?"),
            (["reference", "cornell-diffuse", "--sampler", "soblo"], USAGE, r"did you mean 'sobol'\?"),
            (["converge", "--sampler", "soblo", "--out", "a"], USAGE, r"did you mean 'sobol'\?"),
            (["render", "cornell-diffuse", "--isa", "axv2"], USAGE, r"--isa axv2: .*did you mean 'avx2'\?"),
            (["converge", "--profile", "quikc", "--out", "a"], USAGE, r"--profile quikc: .*did you mean 'quick'\?"),
            (["compare", "a.exr", "b.exr", "--metrics", "sism"], USAGE, r"--metrics sism: .*did you mean 'ssim'\?"),
            (["bench", "--score", "small", "--methods", "pt,gpt"], USAGE,
             r"--score small: has no method gpt; expected none, or some of pt, lt, bpt, mlt, ppm, bpm, vcm$"),
            (["bench", "--methods", "vmc"], USAGE, r"--methods vmc: .*did you mean 'vcm'\?"),
            (["recommend", "cornell-diffuse", "--methods", "vmc"], USAGE, r"did you mean 'vcm'\?"),
            (["render", "cornell-diffuse", "--precision", "flaot"], USAGE, r"did you mean 'float'\?"),
            (["render"], USAGE, r"scene is required; see `wavecrest render --help`"),
            (["render", "cornell-diffuse", "--spp"], USAGE, r"--spp: expected a value; see `wavecrest render --help`"),
            (["render", "cornell-diffuse", "--time", "soon"], USAGE, r"--time 'soon': no duration; expected one like 6s"),
            (["render", "cornell-diffuse", "--size", "32"], USAGE, r"--size '32': no size; expected WIDTHxHEIGHT"),
            (["render", "cornell-diffuse", "--memory", "12"], USAGE, r"--memory '12': no memory size; expected one like"),
            (["converge", "--methods", "pt,vmc", "--out", "a"], USAGE, r"did you mean 'vcm'\?"),
            ([], USAGE, r".*subcommand.*; see `wavecrest --help`"),
        ]:
            with self.subTest(arguments):
                self.assert_one_error_line(self.run_wavecrest(*arguments, expect=code), ".*" + answer)

    def test_help_and_version_have_the_usual_spellings(self):
        self.assertEqual(self.run_wavecrest("help").stdout, self.run_wavecrest("--help").stdout)
        self.assertEqual(
            self.run_wavecrest("help", "compare").stdout, self.run_wavecrest("compare", "--help").stdout
        )
        self.assertEqual(self.run_wavecrest("-V").stdout, self.run_wavecrest("--version").stdout)
        self.assertRegex(self.run_wavecrest("-V").stdout, r"^\d+\.\d+\.\d+ \(([0-9a-f]{12}|unknown)\)\n$")
        self.run_wavecrest("help", "nothing", expect=USAGE)
        self.assertIn("sample_count, or 4", self.run_wavecrest("help", "render").stdout)

    def test_a_dry_run_says_what_it_would_do_and_does_nothing(self):
        result = self.render("--time", "60s", "-m", "vcm", "--dry-run", "-o", "image.exr", "--stats", "stats.json")
        for word in ("cornell-diffuse, 32x24", "vcm", "60 s", "photon map", "image.exr", "stats.json"):
            self.assertIn(word, result.stdout)
        self.assertEqual(list(self.folder.iterdir()), [])
        self.render("--dry-run", "-o", "absent/image.exr", expect=USAGE)
        for beside in ("--view", "--tev", "--stats=-"):
            result = self.render("--dry-run", "-o", "image.exr", beside, expect=USAGE)
            self.assert_one_error_line(result, f"--dry-run and {beside.split('=')[0]}")
        result = self.render("--dry-run", "--until-relative-error", "0.1", "-o", "image.exr")
        self.assertIn("ends     once the relative error is 0.1\n", result.stdout)
        self.render("--dry-run", "--until-relative-error", "0.1", "--snapshot-every", "1s", "-o", "a.exr", expect=USAGE)
        self.render("--dry-run", "--until-ssim", "0.9", "-o", "image.exr", expect=USAGE)
        for images in (["-o", "A.EXR"], ["-o", "a.png", "--snapshot-every", "10s"]):  # snapshots are EXR
            self.assertIn(" MB for the blocks of an EXR ", self.render("--dry-run", *images).stdout)
        self.assertNotIn("blocks of an EXR", self.render("--dry-run", "-o", "a.png").stdout)
        # A guide does not fit, and trials may do without.
        self.assertIn("; of pt, if trials choose it\n", self.render("--dry-run", "-m", "gpt", "--memory", "50M").stdout)
        self.render("--dry-run", "-m", "gpt", "--guide", "radiance", "--memory", "50M", expect=USAGE)

    def test_a_render_ends_with_a_line_about_itself(self):
        self.assertRegex(self.render("--spp", "3", "-o", "image.exr").stderr, r"wavecrest: image\.exr: 3 spp in .*paths/s")
        self.assertIn("wavecrest: cornell-diffuse.exr: 1 spp in", self.render("--spp", "1").stderr)
        self.assertEqual(self.render("--spp", "1", "--progress", "none").stderr, "")

    def test_notes_are_told_whatever_the_progress_and_go_into_the_statistics(self):
        scene = self.write("scene.xml", '<scene version="3.0.0"><integrator type="bdpt"/>'
                           '<sensor type="perspective"/><emitter type="constant"/><shape type="sphere"/></scene>')
        for words, told in ((["--progress", "none"], True), ([], True), (["--quiet"], False)):
            result = self.render("--spp", "1", *words, "--stats", "stats.json", scene=scene)
            self.assertEqual("note: " in result.stderr, told, words)
            (note,) = read_json(self.path("stats.json"))["notes"]
            self.assertIn('integrator "bdpt"', note)
        self.assertEqual(result.stderr, "")
        result = self.render("--spp", "1", "-m", "vcm", "--radius", "0.7", "--quiet", "--stats", "-")
        self.assertIn("--radius 0.7 blurs over the whole scene", json.loads(result.stdout)["notes"][0])
        self.assertEqual(self.render("--spp", "1", "--stats", "stats.json", "--quiet").stderr, "")
        self.assertEqual(read_json(self.path("stats.json"))["notes"], [])

    def test_settings_come_from_arguments_then_a_file_then_variables(self):
        def seed(*arguments, **variables):
            return json.loads(
                self.run_wavecrest(
                    *arguments, "render", "cornell-diffuse", "--size", "8x8", "--spp", "1", "--stats", "-",
                    "--progress", "none", variables=variables,
                ).stdout
            )["seed"]  # fmt: skip

        self.write("settings.toml", "[render]\nseed = 5\n")
        self.assertEqual(seed(), 0)
        self.assertEqual(seed(WAVECREST_SEED="7"), 7)
        self.assertEqual(seed("--config", "settings.toml", WAVECREST_SEED="7"), 5)
        result = self.run_wavecrest(
            "render", "cornell-diffuse", "--config", "settings.toml", "--size", "8x8", "--spp", "1", "--seed", "9",
            "--stats", "stats.json",
        )  # fmt: skip
        self.assertEqual(read_json(self.path("stats.json"))["seed"], 9, result.stderr)
        self.write("settings.toml", "[render]\nsede = 5\n")
        wrong = self.run_wavecrest("--config", "settings.toml", "render", "cornell-diffuse", "--spp", "1", expect=USAGE)
        self.assert_one_error_line(wrong, r"settings\.toml: unknown setting 'render\.sede'; did you mean '--seed'\?")
        # What is wrong with a value says where it is from.
        self.write("settings.toml", '[render]\nseed = "five"\n')
        render = ("render", "cornell-diffuse", "--spp", "1")
        wrong = self.run_wavecrest("--config", "settings.toml", *render, expect=USAGE)
        self.assert_one_error_line(wrong, r"settings\.toml: --seed: 'five' is no whole number")
        wrong = self.run_wavecrest(*render, expect=USAGE, variables={"WAVECREST_SEED": "six"})
        self.assert_one_error_line(wrong, r"WAVECREST_SEED: --seed: 'six' is no whole number")
        wrong = self.run_wavecrest(*render, "--seed", "6x", expect=USAGE, variables={"WAVECREST_SEED": "six"})
        self.assert_one_error_line(wrong, r"--seed: '6x' is no whole number")
        # Commands without the option do not read it.
        self.run_wavecrest("scenes", variables={"WAVECREST_SEED": "six"})
        self.run_wavecrest("--config", "absent.toml", "scenes", expect=USAGE)

    def test_a_variable_never_contradicts_what_was_asked_for(self):
        for chains in (["--mlt", "pssmlt"], ["--no-direct-pass"]):
            chains = ["-m", "mlt", *chains, "--chains", "50", "--bootstrap", "400", "--spp", "1", "-o", "a.pfm"]
            command = ["render", "cornell-diffuse", "--size", "8x8", *chains]
            self.run_wavecrest(*command, variables={"WAVECREST_SAMPLER": "sobol"})
            wrong = self.run_wavecrest(*command, "--sampler", "sobol", expect=USAGE)
            self.assert_one_error_line(wrong, "--sampler sobol: is for the direct pass")
        for row in ("pt-auto", "mlt-pssmlt"):
            command = ["converge", "cornell-diffuse", "--size", "8x8", "--spp", "1", "--seeds", "1", "--methods", row]
            self.run_wavecrest(*command, "--out", row, variables={"WAVECREST_SAMPLER": "sobol"})
            wrong = self.run_wavecrest(*command, "--sampler", "sobol", "--out", "b", expect=USAGE)
            self.assert_one_error_line(wrong, "--sampler: is for no row of the campaign")

    def test_variables_of_the_caller_reach_no_test(self):
        command = [sys.executable, "-c", "import harness, os; print(sorted(set(os.environ) & {'WAVECREST_SIZE', 'WAVECREST'}))"]
        result = subprocess.run(command, cwd=pathlib.Path(__file__).parent, env=os.environ | {"WAVECREST_SIZE": "8x8"},
                                capture_output=True, text=True, check=True)  # fmt: skip
        self.assertEqual(result.stdout, "['WAVECREST']\n")

    def test_commands_that_several_processes_cannot_share_are_refused_after_options_too(self):
        self.write("render", "")
        launch = {"OMPI_COMM_WORLD_SIZE": "2", "OMPI_COMM_WORLD_RANK": "0"}
        for options in ([], ["--config", "render"], ["--config=render"]):
            result = self.run_wavecrest(*options, "merge", "a", "-o", "b.pfm", expect=USAGE, variables=launch)
            self.assert_one_error_line(result, "merge: mpirun has started 2 processes")

    def test_scenes_are_told_as_json(self):
        scenes = json.loads(self.run_wavecrest("scenes", "--json").stdout)
        self.assertEqual(len(scenes), 9)
        for scene in scenes:
            self.assertTrue(os.path.isfile(scene["file"]) and scene["description"])

    def test_an_output_that_no_format_fits_is_refused_before_rendering(self):
        for name in ("image.foo", "image", "image.exr.bak", "absent/image.exr"):
            self.render("--time", "60s", "-o", self.path(name), expect=USAGE)
        self.render("--time", "60s", "--stats", self.path("absent/stats.json"), expect=USAGE)

    def test_scenes_lists_the_built_in_scenes(self):
        names = [line.split()[0] for line in self.run_wavecrest("scenes").stdout.splitlines()]
        self.assertEqual(
            sorted(names),
            ["cornell-diffuse", "cornell-glossy", "cornell-mirror", "cornell-spheres", "dragon-caustics",
             "dragon-caustics-glossy", "lafortune-room", "pool-interior", "veach-door"],
        )


if __name__ == "__main__":
    unittest.main()
