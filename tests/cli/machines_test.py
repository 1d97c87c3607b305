"""wavecrest bench --machines: the committed scores, and those of one's own, beside each other."""

import json
import pathlib
import shutil
import unittest

from harness import DONE, INPUT, USAGE, CommandTest, read_json
from results_schema import validate

COMMITTED = pathlib.Path(__file__).parents[2] / "bench" / "score" / "machines"


class Machines(CommandTest):
    def test_each_committed_score_is_a_result_and_says_nothing_of_where_it_was_measured(self):
        self.assertTrue(list(COMMITTED.glob("*.json")))
        for file in COMMITTED.glob("*.json"):
            validate(read_json(file))
            self.assertNotIn("/home", file.read_text())

    def test_the_committed_scores_are_shown_with_ones_own(self):
        mine = read_json(next(COMMITTED.glob("*.json")))
        mine["machine"]["cpu"], mine["score"] = "My own", 123456
        shutil.copytree(COMMITTED, self.path("all"))
        self.write("all/mine.json", json.dumps(mine))
        self.write("all/other.json", json.dumps({"kind": "throughput"}))
        told = self.run_wavecrest("bench", "--machines", self.path("all"), "--json", self.path("m.json"), "--html",
                                  self.path("m.html"), expect=DONE)
        self.assertRegex(told.stdout, r"(?m)^  My own +\d+ +123456 ")
        self.assertIn("other.json: is no score; left out", told.stderr)
        result = read_json(self.path("m.json"))
        validate(result)
        self.assertEqual(len(result["scores"]), len(list(COMMITTED.glob("*.json"))) + 1)
        self.assertIn("<th>My own", pathlib.Path(self.path("m.html")).read_text())

    def test_what_is_no_score_is_one_line(self):
        for content, answer in [("{", "is no JSON$"), ('{"kind": "score"}', "is no score of wavecrest bench"),
                                ('{"kind": "score", "score_version": 0}', "is of another score version")]:
            with self.subTest(content):
                file = self.write("damaged.json", content)
                told = self.run_wavecrest("bench", "--machines", file, expect=INPUT)
                self.assert_one_error_line(told, r".*damaged\.json: " + answer)
        told = self.run_wavecrest("bench", "--machines", self.path("none"), expect=INPUT)
        self.assert_one_error_line(told, ".*none: cannot be read")
        told = self.run_wavecrest("bench", "cornell-diffuse", "--machines", str(COMMITTED), expect=USAGE)
        self.assert_one_error_line(told, "--machines measures nothing")


if __name__ == "__main__":
    unittest.main()
