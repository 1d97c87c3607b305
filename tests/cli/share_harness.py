"""What tests of renders that are shared, by parts or by processes, have in common."""

import struct

from harness import CommandTest, read_pfm

CHAINS, RADIUS = ["--chains", "50", "--bootstrap", "400"], ["--radius", "0.05"]
# mlt restarts its chains within the render: an epoch has 128 steps of 50 chains.
METHODS = {"pt": [], "lt": [], "bpt": [], "mlt": CHAINS, "ppm": RADIUS, "bpm": RADIUS, "vcm": RADIUS}
COUNTS = ("iterations", "camera_paths", "light_paths", "mutations", "nonfinite_samples", "scene_hash", "seed")


def bits(value):
    return struct.unpack("<i", struct.pack("<f", value))[0]


class ShareTest(CommandTest):
    def image(self, name):
        return read_pfm(self.path(name))

    def assert_equal_but_for_rounding(self, one, other, said):
        self.assertEqual(one[:2], other[:2], said)
        worst = max(abs(bits(a) - bits(b)) for a, b in zip(one[2], other[2]))
        self.assertLessEqual(worst, 1, said)
        self.assertGreater(sum(one[2]), 0, said)
