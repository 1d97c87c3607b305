"""The example notebooks run from top to bottom, and show what they promise."""

import os
import pathlib
import sys
import unittest

import nbclient
import nbformat

EXAMPLES = pathlib.Path(__file__).resolve().parent.parent.parent / "python" / "examples"


class Notebooks(unittest.TestCase):
    def test_every_notebook_runs(self):
        os.environ["SECONDS_PER_METHOD"] = "1"
        notebooks = sorted(EXAMPLES.glob("*.ipynb"))
        self.assertTrue(notebooks)
        for file in notebooks:
            notebook = nbformat.read(file, as_version=4)
            nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3").execute()
            outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
            kinds = {kind for output in outputs for kind in output.get("data", {})}
            self.assertTrue({"text/html", "image/png"} <= kinds, kinds)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[1:]])
