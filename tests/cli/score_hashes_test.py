"""The committed hashes and pictures that validate scores are those of this build, for the size small.

Here on each instruction set for two of its scenes; tests/bench/score/picture_test.cpp has all of them on the best one.
"""

import json
import pathlib
import unittest

from harness import CommandTest, read_json

SCORE = pathlib.Path(__file__).parents[2] / "bench" / "score"
COMMITTED = SCORE / "image_hashes.json"
PICTURES = SCORE / "image_pictures.json"
REMAKE = "after a change that changes images on purpose: bench/score/remake-hashes build/release/wavecrest"


class Hashes(CommandTest):
    def test_are_those_of_this_build(self):
        self.run_wavecrest("bench", "cornell-diffuse", "pool-interior", "--score", "small",
                           "--write-hashes", self.path("hashes.json"))
        committed = read_json(COMMITTED)["images"].get("small", {})
        here = read_json(self.path("hashes.json"))["images"]["small"]
        known = [group for group in here if group in committed]
        if not known:
            self.skipTest(f"no hashes are committed for {', '.join(here)}")
        for group in known:
            self.assertEqual(here[group], {scene: committed[group][scene] for scene in here[group]}, REMAKE)

    def test_are_in_the_order_in_which_they_are_written(self):
        """So that remaking them changes no other line."""
        for file in COMMITTED, PICTURES:
            text = file.read_text()
            self.assertEqual(text, json.dumps(json.loads(text), indent=1) + "\n")

    def test_the_build_is_known_that_made_them(self):
        hashes = read_json(COMMITTED)
        for size, groups in hashes["images"].items():
            self.assertEqual(list(groups), list(hashes["builds"][size]))

    def test_every_image_of_the_size_small_has_a_picture(self):
        hashes, pictures = read_json(COMMITTED)["images"]["small"], read_json(PICTURES)["pictures"]["small"]
        for scenes in hashes.values():
            self.assertEqual({scene: list(methods) for scene, methods in scenes.items()},
                             {scene: list(methods) for scene, methods in pictures.items()})


if __name__ == "__main__":
    unittest.main()
