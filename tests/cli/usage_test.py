"""Options: what is wrong on the command line ends with exit code 2 before anything is rendered."""

import json
import os
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

    def test_words_of_a_list_name_the_choices(self):
        self.assertIn("float, double, fast", self.render("--precision", "half", expect=USAGE).stderr)
        self.assertIn("auto, embree, small", self.render("--accel", "kd", expect=USAGE).stderr)

    def test_ten_mistakes_are_each_answered_with_a_useful_line(self):
        for arguments, code, answer in [
            (["rendr", "cornell-diffuse"], USAGE, r"unknown command 'rendr'; did you mean 'render'\?"),
            (["render", "cornell-difuse"], INPUT, r"cornell-difuse.*did you mean 'cornell-diffuse'\?"),
            (["render", "cornell-diffuse", "--smaples", "4"], USAGE, r"unknown argument '--smaples'"),
            (["render", "cornell-diffuse", "--thread=4"], USAGE, r"'--thread=4'; did you mean '--threads'\?"),
            (["render", "cornell-diffuse", "-m", "bdt"], USAGE, r"--method bdt: .*did you mean 'bpt'\?"),
            (["render", "cornell-diffuse", "--sampler", "soblo"], USAGE, r"--sampler soblo: expected independent or sobol"),
            (["render", "cornell-diffuse", "--precision", "flaot"], USAGE, r"did you mean 'float'\?"),
            (["render"], USAGE, r"scene is required; see `wavecrest render --help`"),
            (["render", "cornell-diffuse", "--spp"], USAGE, r"--spp.*see `wavecrest render --help`"),
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
        self.run_wavecrest("help", "nothing", expect=USAGE)
        self.assertIn("sample_count, or 4", self.run_wavecrest("help", "render").stdout)

    def test_a_dry_run_says_what_it_would_do_and_does_nothing(self):
        result = self.render("--time", "60s", "-m", "vcm", "--dry-run", "-o", "image.exr", "--stats", "stats.json")
        for word in ("cornell-diffuse, 32x24", "vcm", "60 s", "photon map", "image.exr", "stats.json"):
            self.assertIn(word, result.stdout)
        self.assertEqual(list(self.folder.iterdir()), [])
        self.render("--dry-run", "-o", "absent/image.exr", expect=USAGE)

    def test_a_render_ends_with_a_line_about_itself(self):
        self.assertRegex(self.render("--spp", "3", "-o", "image.exr").stderr, r"wavecrest: image\.exr: 3 spp in .*paths/s")
        self.assertIn("no -o, so the image was not kept", self.render("--spp", "1").stderr)
        self.assertEqual(self.render("--spp", "1", "--progress", "none").stderr, "")

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
        self.assert_one_error_line(wrong, r".*sede")
        self.run_wavecrest("--config", "absent.toml", "scenes", expect=USAGE)

    def test_scenes_are_told_as_json(self):
        scenes = json.loads(self.run_wavecrest("scenes", "--json").stdout)
        self.assertEqual(len(scenes), 9)
        for scene in scenes:
            self.assertTrue(os.path.isfile(scene["file"]) and scene["description"])

    def test_snapshots_need_a_name(self):
        self.render("--snapshot-every", "1s", "--spp", "1", expect=USAGE)

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
