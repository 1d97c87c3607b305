"""tools/run_checks.py: steps configure all that an earlier one may have left in the build folder, as other scripts do
that build for all machines, and tell their times."""

import contextlib
import io
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import types
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

import run_checks  # noqa: E402  (the path has to be set first)

PRESET = ["cmake", "--preset", "release"]


def calls_of(steps):
    """What the steps run, and how they call test()."""
    with mock.patch.object(run_checks, "run", return_value=True) as run, mock.patch.object(run_checks, "test") as test:
        for step in steps:
            step(run_checks.Tally())
    return [list(map(str, call.args[2])) for call in run.call_args_list], test.call_args_list


def configurations_by_script(script, *arguments):
    """The arguments of each configuration by a copy of the script, with stand-ins for all that builds."""
    with tempfile.TemporaryDirectory(prefix="wavecrest_run_checks_") as name:
        folder = pathlib.Path(name)
        for program in ("programs/cmake", "programs/cpack", "tools/install-packages"):
            (folder / program).parent.mkdir(exist_ok=True)
            (folder / program).write_text('#!/bin/sh\necho "$@" >> "$CALLS"\n')
            (folder / program).chmod(0o755)
        shutil.copy(ROOT / script, folder / script)
        calls = folder / "calls"
        environment = {**os.environ, "PATH": f"{folder / 'programs'}:{os.environ['PATH']}", "CALLS": str(calls)}
        subprocess.run([folder / script, *arguments], env=environment, check=True, capture_output=True)
        lines = [line.split() for line in calls.read_text().splitlines()]
    return [line for line in lines if line[:2] == ["--preset", "release"]]


def configurations(steps):
    """The options of each time that the steps configure build/release, by name."""
    return [
        dict(re.findall(r"-D(WAVECREST_\w+)=(\S+)", " ".join(command)))
        for command in calls_of(steps)[0]
        if command[:3] == PRESET
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

    def test_builds_for_all_machines_keep_no_narrower_kernels(self):
        commands = [command for command in calls_of(run_checks.STEPS.values())[0] if command[:3] == PRESET]
        commands += configurations_by_script("quickstart", "--build-only")
        commands += configurations_by_script("tools/make-package", "build/package", "-DWAVECREST_ISAS=native")
        for command in commands:
            self.assertIn("-UWAVECREST_ISAS", command)
            self.assertIn("-UWAVECREST_ONLY_COMPLETE_KERNELS", command)
        # Of both the last one counts.
        self.assertLess(commands[-1].index("-UWAVECREST_ISAS"), commands[-1].index("-DWAVECREST_ISAS=native"))

    def test_wheels_have_the_default_kernels(self):
        default = re.search(r'set\(WAVECREST_ISAS "(.+?)" CACHE', (ROOT / "CMakeLists.txt").read_text())[1]
        project = (ROOT / "pyproject.toml").read_text()
        self.assertIn(f'\nWAVECREST_ISAS = "{default}"\nWAVECREST_ONLY_COMPLETE_KERNELS = false\n', project)

    def test_a_compiler_cache_is_for_the_environment_to_choose(self):
        with mock.patch("shutil.which", return_value="/usr/bin/ccache"):
            commands, _ = calls_of(run_checks.STEPS.values())
        self.assertNotIn("LAUNCHER", str(commands))

    def test_a_suppressions_file_may_have_spaces_in_its_path(self):
        _, (test,) = calls_of([run_checks.step_tsan])
        self.assertIn(f"suppressions='{ROOT}/tools/tsan.supp' ", test.kwargs["TSAN_OPTIONS"])

    def test_a_wheel_takes_the_packages_of_releases(self):
        commands, _ = calls_of([run_checks.step_wheel])
        self.assertEqual(commands[0], ["tools/install-packages", "release"])

    def test_long_tests_render_mitsubas_pictures(self):
        _, (test,) = calls_of([run_checks.step_long])
        self.assertEqual(test.kwargs["ORACLE_LIVE"], "1")
        for label in ("long", "oracle"):
            self.assertRegex(label, test.args[-1])


class Times(unittest.TestCase):
    def said(self, function, *arguments):
        with contextlib.redirect_stdout(io.StringIO()) as out:
            function(*arguments)
        return out.getvalue().splitlines()

    def test_each_step_says_how_many_cores_it_kept_busy(self):
        tally = run_checks.Tally()
        for user, system, cores in ((12, 3, "1.5"), (20, 3, "0.8"), (20, 3, "0.0")):
            times = types.SimpleNamespace(children_user=user, children_system=system)
            with mock.patch("os.times", return_value=times), mock.patch("time.monotonic", return_value=110):
                self.assertEqual(self.said(tally.end, "a", 100, "done"), [f"=== a: done in 10 s, {cores} cores busy"])

    def test_the_slowest_tests_come_first_and_the_others_not_at_all(self):
        cases = "".join(f'<testcase name="case {i}" time="{i / 2}"/>' for i in range(50))
        batch = '<testcase classname="Suite" name="case" time="24.3"/>'
        with tempfile.TemporaryDirectory(prefix="wavecrest_run_checks_") as folder:
            report = pathlib.Path(folder) / "junit.xml"
            report.write_text(f"<testsuite>{cases}</testsuite>")
            (report.parent / "batches").mkdir()
            (report.parent / "batches" / "a.batch0.xml").write_text(f"<testsuites>{batch}</testsuites>")
            lines = self.said(run_checks.print_slowest, report)
        self.assertEqual(lines[0].split(), ["24.5", "s", "case", "49"])
        self.assertEqual(lines[1].split(), ["24.3", "s", "Suite.case"])
        self.assertEqual(lines[-1].split(), ["5.5", "s", "case", "11"])


if __name__ == "__main__":
    unittest.main()
