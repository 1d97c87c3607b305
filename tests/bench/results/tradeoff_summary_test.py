"""bench/results/tradeoff_summary shows the settings that are in the results."""

import contextlib
import io
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).parents[3]
sys.path.insert(0, str(ROOT / "tests"))
from program_module import program_module  # noqa: E402


def row(knob, value):
    bias = {"value": 0.0, "standard_error": 0.0}
    return {"knob": knob, "value": value, "speed": 1.0, "efficiency": 1.0, "efficiency_interval": [0.9, 1.1],
            "bias": bias, "worst_block": bias, "biased": False}


class Summary(unittest.TestCase):
    summary = program_module("bench/results/tradeoff_summary")
    settings = [("baseline", "float"), ("--precision", "double"), ("kernels", "complete"), ("--wave", "512")]
    results = [{"scene": "box", "method": "pt", "rows": [row(*both) for both in settings]}]

    def test_every_entry_of_the_legend_has_points(self):
        picture = self.summary.draw(self.results)
        legend = r'<circle class="(s\d)"[^>]* r="5"/><text [^>]*>([^<]*)<'
        self.assertEqual(re.findall(legend, picture), [("s0", "precision double"), ("s1", "kernels complete")])
        self.assertEqual(re.findall(r'<circle class="(s\d)"[^>]* r="4.5"/>', picture), ["s0", "s1"])

    def test_biases_are_those_of_all_settings_but_double(self):
        text = io.StringIO()
        with contextlib.redirect_stdout(text):
            self.summary.print_tables(self.results)
        efficiencies, biases = text.getvalue().split("\n\n")
        self.assertIn("| scene | method | --precision double | kernels complete | --wave 512 |", efficiencies)
        judged = re.findall(r"^\| box \| pt \| ([^|]*) \|", biases, re.MULTILINE)
        self.assertEqual(judged, ["baseline float", "kernels complete"])


if __name__ == "__main__":
    unittest.main()
