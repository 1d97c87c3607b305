"""bench/extremes/lost-samples goes on with what is in its folder, and with nothing else."""

import argparse
import importlib.machinery
import importlib.util
import json
import pathlib
import subprocess
import tempfile
import unittest

LOST_SAMPLES = pathlib.Path(__file__).parents[2] / "bench" / "extremes" / "lost-samples"


def lost_samples_module():
    """The program, which has no ending, as a module."""
    loader = importlib.machinery.SourceFileLoader("lost_samples", str(LOST_SAMPLES))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("lost_samples", loader))
    loader.exec_module(module)
    return module


class LostSamples(unittest.TestCase):
    def test_only_whole_renders_of_this_size_are_taken_from_the_folder(self):
        module = lost_samples_module()
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
