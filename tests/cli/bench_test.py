"""wavecrest bench: every method is measured, and its stages take up its time."""

import unittest

from harness import DONE, CommandTest, read_json

# Stages that must be among those of a method: of both passes, and of what is built between them.
STAGES = {
    "pt": ["extend", "next event"],
    "lt": ["extend light", "connect to camera", "scatter specular"],
    "bpt": ["store", "connect", "occlude connection"],
    "mlt": ["extend"],
    "ppm": ["store", "photon map", "merge"],
    "bpm": ["store", "photon map", "merge"],
    "vcm": ["store", "photon map", "connect", "merge"],
}


class Bench(CommandTest):
    def test_the_stages_of_every_method_take_up_its_time(self):
        output = self.path("bench.json")
        told = self.run_wavecrest(
            "bench", "cornell-diffuse", "--methods", ",".join(STAGES), "--size", "24x16",
            "--duration", "1s", "--threads", "1", "--json", output, expect=DONE,
        )
        self.assertNotRegex(told.stdout, r"\b(inf|nan)\b")
        methods = read_json(output)["scenes"][0]["methods"]
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
            if entry["method"] != "pt":  # whose stages and whole are measured in turn, not in one
                self.assertLess(sum(shares.values()), 1 + 1e-6, entry["method"])
            self.assertEqual("bare_embree" in entry, entry["method"] == "pt", entry["method"])


if __name__ == "__main__":
    unittest.main()
