"""wavecrest bench --against: two builds in turn, of which a slower one is found."""

import json
import os
import unittest

from harness import CHECK, DONE, INPUT, USAGE, WAVECREST, CommandTest, read_json
from results_schema import validate


class Against(CommandTest):
    """Two builds in turn. The other build is this one, behind a script that may change the time it tells."""

    ARGUMENTS = ("cornell-diffuse", "--methods", "pt,lt", "--size", "16x16", "--duration", "0.2s")

    def other_build(self, times, first=""):
        script = self.write(
            "other",
            "#!/usr/bin/env python3\n"
            "import json, subprocess, sys\n"
            f"{first}\n"
            f"code = subprocess.call([{WAVECREST!r}, *sys.argv[1:]])\n"
            "stats = sys.argv[sys.argv.index('--stats') + 1]\n"
            "content = json.load(open(stats))\n"
            f"content['cpu_seconds'] *= {times}\n"
            "json.dump(content, open(stats, 'w'))\n"
            "sys.exit(code)\n",
        )
        os.chmod(script, 0o755)
        return script

    def test_a_build_against_itself_gives_no_verdict_and_the_same_images(self):
        # No ranks of twelve pairs are as unlikely as this level.
        self.run_wavecrest("bench", *self.ARGUMENTS, "--against", WAVECREST, "--family-level", "1e-6",
                           "--json", self.path("out.json"), expect=DONE)
        result = read_json(self.path("out.json"))
        validate(result)
        rows = result["comparisons"]
        self.assertEqual([(row["scene"], row["method"]) for row in rows],
                         [("cornell-diffuse", "pt"), ("cornell-diffuse", "lt")])
        self.assertEqual(result["in_place"], [])
        for row in rows:
            self.assertTrue(row["same_image"])
            self.assertEqual(row["verdict"], "no difference")
            self.assertEqual(len(row["cpu_seconds"]), len(row["other_cpu_seconds"]))
            self.assertTrue(row["interval"][0] <= row["speedup"] <= row["interval"][1], row)

    def test_a_slower_build_ends_with_exit_code_4(self):
        told = self.run_wavecrest("bench", *self.ARGUMENTS, "--against", self.other_build(0.2), expect=CHECK)
        self.assertRegex(told.stdout, r"\bslower\b")

    def test_a_faster_build_is_called_faster(self):
        told = self.run_wavecrest("bench", *self.ARGUMENTS, "--against", self.other_build(5), expect=DONE)
        self.assertRegex(told.stdout, r"\bfaster\b")

    def test_a_build_that_must_stay_where_it_is_is_measured_there(self):
        other = self.other_build(1, first="assert sys.argv[0].endswith('/other')")
        told = self.run_wavecrest("bench", *self.ARGUMENTS, "--against", other, "--family-level", "1e-6",
                                  "--json", self.path("out.json"), expect=DONE)
        self.assertIn(f"{other} runs only where it stands", told.stdout)
        self.assertEqual(read_json(self.path("out.json"))["in_place"], [str(other)])

    def test_children_get_no_defaults_of_options_but_that_they_are_on_their_own(self):
        first = "import os\nassert [os.environ.get('WAVECREST_' + x) for x in ('MPI', 'SAMPLER')] == ['off', None]"
        other = self.other_build(1, first=first)
        self.run_wavecrest("bench", *self.ARGUMENTS, "--against", other, "--family-level", "1e-6", expect=DONE,
                           variables={"WAVECREST_MPI": "off", "WAVECREST_SAMPLER": "independent"})

    def test_what_cannot_be_run_is_a_usage_error(self):
        result = self.run_wavecrest("bench", "--against", self.path("nothing"), expect=USAGE)
        self.assert_one_error_line(result, "--against .*expected the path of a wavecrest")

    def test_a_program_that_is_no_wavecrest_is_bad_input(self):
        result = self.run_wavecrest("bench", *self.ARGUMENTS, "--against", "/bin/true", expect=INPUT)
        self.assert_one_error_line(result, "/bin/true: its --stats are not those of a wavecrest render")


if __name__ == "__main__":
    unittest.main()
