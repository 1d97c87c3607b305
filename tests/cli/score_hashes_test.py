"""The committed hashes that validate scores are those of this build, for the size small."""

import json
import pathlib
import unittest

from harness import CommandTest, read_json

COMMITTED = pathlib.Path(__file__).parents[2] / "bench" / "score" / "image_hashes.json"
REMAKE = "after a change that changes images on purpose: bench/score/remake-hashes build/release/wavecrest"


class Hashes(CommandTest):
    def test_are_those_of_this_build(self):
        self.run_wavecrest("bench", "--score", "small", "--write-hashes", self.path("hashes.json"))
        committed = read_json(COMMITTED)["images"].get("small", {})
        here = read_json(self.path("hashes.json"))["images"]["small"]
        known = [group for group in here if group in committed]
        if not known:
            self.skipTest(f"no hashes are committed for {', '.join(here)}")
        for group in known:
            self.assertEqual(here[group], committed[group], REMAKE)

    def test_are_in_the_order_in_which_they_are_written(self):
        """So that remaking them changes no other line."""
        text = COMMITTED.read_text()
        self.assertEqual(text, json.dumps(json.loads(text), indent=1) + "\n")


if __name__ == "__main__":
    unittest.main()
