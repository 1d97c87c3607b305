"""tools/run_checks.py: no step of ./check builds what an earlier one has left in the cache of its build folder."""

import pathlib
import re
import sys
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))

import run_checks  # noqa: E402  (the path has to be set first)


def configurations(steps):
    """The options of each time that the steps configure build/release, by name."""
    with mock.patch.object(run_checks, "run", return_value=True) as run, mock.patch.object(run_checks, "test"):
        for step in steps:
            step(run_checks.Tally())
    commands = [call.args[2] for call in run.call_args_list]
    return [
        dict(re.findall(r"-D(WAVECREST_\w+)=(\S+)", " ".join(map(str, command))))
        for command in commands
        if command[:3] == ["cmake", "--preset", "release"]
    ]


class Options(unittest.TestCase):
    def test_each_step_says_all_that_another_changes(self):
        found = configurations(run_checks.STEPS.values())
        self.assertGreater(len(found), 5)
        self.assertEqual(len({frozenset(options) for options in found}), 1, found)

    def test_a_release_has_the_library_and_no_python(self):
        (options,) = configurations([run_checks.step_release])
        self.assertEqual((options["WAVECREST_SHARED"], options["WAVECREST_PYTHON"]), ("ON", "OFF"))
        (options,) = configurations([run_checks.step_python])
        self.assertEqual(options["WAVECREST_PYTHON"], "ON")


if __name__ == "__main__":
    unittest.main()
