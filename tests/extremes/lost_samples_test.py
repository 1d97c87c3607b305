"""bench/extremes/lost-samples goes on with what is in its folder, and with nothing else."""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))
from program_module import program_module  # noqa: E402


class LostSamples(unittest.TestCase):
    def test_only_whole_renders_of_this_size_are_taken_from_the_folder(self):
        module = program_module("bench/extremes/lost-samples")
        stats = {"width": 128, "height": 124, "iterations": 1024}
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "veach-door-pt.json"

            def render(spp, size):
                # /bin/false is a renderer that fails.
                asked = argparse.Namespace(wavecrest="/bin/false", folder=file.parent, spp=spp, size=size)
                return module.render(asked, "veach-door", "pt")

            file.write_text(json.dumps(stats))
            self.assertEqual(render(1024, "128x124"), stats)
            for spp, size in [(2048, "128x124"), (1024, "128x96")]:
                with self.subTest(spp=spp, size=size), self.assertRaises(subprocess.CalledProcessError):
                    render(spp, size)
            file.write_text("")
            with self.assertRaises(subprocess.CalledProcessError):
                render(1024, "128x124")


if __name__ == "__main__":
    unittest.main()
