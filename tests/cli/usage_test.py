"""Options: what is wrong on the command line ends with exit code 2 before anything is rendered."""

import unittest

from harness import DONE, USAGE, CommandTest


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
            ("--max-depth", "1000"),
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
