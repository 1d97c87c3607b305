"""Runs the steps of ./check and counts every test case, build and lint run as one item that passed or failed.

In: the source tree; --steps picks some. Out: the tools' own output, how long each step took, what failed and the end of
what it said, and as the last line `N passed, N failed`; status 1 if anything failed. Test counts come from ctest's
JUnit file, never from its text: a test that could not start (missing executable, failed fixture) is a failure here, one
that said "skip" is listed and not counted.

Whoever keeps a compiler cache sets CMAKE_CXX_COMPILER_LAUNCHER=ccache in the environment, which CMake reads when it
configures a build folder; without it headers are precompiled (cmake/precompiled_headers.cmake).
"""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree

import junit_cases

ROOT = pathlib.Path(__file__).resolve().parent.parent
JOBS = os.cpu_count() or 1
TEST_TIMEOUT_SECONDS = 600
SHOWN_LINES = 12  # of what a failed test said, in the summary
SHOWN_CASES = 40  # of each step's tests, the slowest
# A build folder keeps the options of its last configuration: every step says those that some step changes, and resets
# the choice of kernels, which somebody may have made by hand.
RELEASE_OPTIONS = (
    "-UWAVECREST_ISAS",
    "-UWAVECREST_ONLY_COMPLETE_KERNELS",
    "-DWAVECREST_SHARED=ON",
    "-DWAVECREST_PYTHON=OFF",
    "-DWAVECREST_MPI=AUTO",
)


class Tally:
    """What has passed, failed and been skipped so far, by name, and the seconds that each step took."""

    def __init__(self):
        self.passed = []
        self.failed = []  # with what it said last, if anything
        self.skipped = []
        self.seconds = {}
        self.cpu = 0.0  # seconds of the processor that all steps so far have used

    def record(self, name, held):
        (self.passed if held else self.failed).append(name)
        return held

    def end(self, name, start, outcome):
        self.seconds[name] = time.monotonic() - start
        times = os.times()
        cpu = times.children_user + times.children_system
        busy = f", {(cpu - self.cpu) / self.seconds[name]:.1f} cores busy" if self.seconds[name] >= 1 else ""
        self.cpu = cpu
        print(f"=== {name}: {outcome} in {self.seconds[name]:.0f} s{busy}", flush=True)


def run(tally, name, command, **environment):
    """Runs one command as one item of the tally; true if it succeeded."""
    print(f"\n=== {name}: {' '.join(map(str, command))}", flush=True)
    start = time.monotonic()
    status = subprocess.run(command, cwd=ROOT, env={**os.environ, **environment}, check=False).returncode
    tally.end(name, start, "done" if status == 0 else "FAILED")
    return tally.record(name, status == 0)


def build(tally, preset, *options, targets=("all",)):
    """Configures and builds a preset or some targets of it."""
    if preset == "release":
        options = (*RELEASE_OPTIONS, *options)  # of two values for an option the last counts
    return run(tally, f"{preset}: configure", ["cmake", "--preset", preset, *options]) and run(
        tally, f"{preset}: build", ["cmake", "--build", "--preset", preset, "--parallel", str(JOBS), "--target", *targets]
    )


def read_junit(tally, step, report):
    """Adds the test cases of a ctest JUnit file, and of its batches; returns how many failed."""
    failed = len(tally.failed)
    for case in junit_cases.read(report, report.parent / "batches"):
        name = f"{step}: {case.name}"
        if case.outcome == "passed":
            tally.passed.append(name)
        elif case.outcome == "skipped":
            tally.skipped.append(name)
        else:
            tally.failed.append("\n    ".join([f"{name}{f' ({case.why})' if case.why else ''}", *case.said[-SHOWN_LINES:]]))
    return len(tally.failed) - failed


def print_slowest(report):
    """The tests of a ctest JUnit file that took longest, batches and their cases among them."""
    times = []
    for file in (report, *(report.parent / "batches").glob("*.xml")):
        for case in ElementTree.parse(file).getroot().iter("testcase"):
            name = case.get("name") if file == report else f"{case.get('classname')}.{case.get('name')}"
            times.append((float(case.get("time", 0)), name))
    for seconds, name in sorted(times, reverse=True)[:SHOWN_CASES]:
        print(f"    {seconds:6.1f} s  {name}")


def test(tally, preset, *selection, batches=True, **environment):
    """Runs the tests of a built preset, each test case being an item; several cases of a program to a process, or one."""
    step = f"{preset}: tests"
    report = ROOT / "build" / preset / "junit.xml"
    report.unlink(missing_ok=True)
    shutil.rmtree(report.parent / "batches", ignore_errors=True)
    command = ["ctest", "--test-dir", f"build/{preset}", *(["--build-config", "batches"] if batches else [])]
    command += ["--output-junit", str(report), "--output-on-failure"]
    # One more than there are cores: some tests wait more than they compute.
    command += ["--no-tests=error", "--parallel", str(JOBS + 1), "--timeout", str(TEST_TIMEOUT_SECONDS), *selection]
    print(f"\n=== {step}: {' '.join(command)}", flush=True)
    start = time.monotonic()
    status = subprocess.run(command, cwd=ROOT, env={**os.environ, **environment}, check=False).returncode
    try:
        failures = read_junit(tally, step, report)
        print_slowest(report)
    except (OSError, ElementTree.ParseError) as error:
        tally.failed.append(f"{step}: no readable result ({error})")
        failures = 1
    if status != 0 and failures == 0:  # no test found, or ctest itself failed
        tally.failed.append(f"{step}: ctest ended with status {status}")
    tally.end(step, start, "done" if status == 0 and failures == 0 else "FAILED")


def step_release(tally):
    if not build(tally, "release"):
        return
    if os.environ.get("CHECK_OFFLINE") == "1":
        print("CHECK_OFFLINE=1: the tests against Mitsuba (label oracle) are left out")
        test(tally, "release", "--label-exclude", "^(oracle|long|browser|mpi|slurm)$")
    else:
        test(tally, "release", "--label-exclude", "^(long|browser|mpi|slurm)$")


def python_options(tally):
    """The environment that the Python module is built for, and how to configure for it."""
    run(tally, "python: environment", ["tools/python-venv", "--python"])
    return ("-DWAVECREST_PYTHON=ON", f"-DPython_EXECUTABLE={ROOT}/build/venv/bin/python")


def step_python(tally):
    targets = ("wavecrest", "wavecrest_python_stub", "wavecrest_scene_assets")
    if build(tally, "release", *python_options(tally), targets=targets):
        test(tally, "release", "--label-regex", "^python$")


def step_long(tally):
    """Long tests, and those against Mitsuba with pictures rendered here in place of committed means."""
    if build(tally, "release"):
        test(tally, "release", "--label-regex", "^(long|oracle)$", batches=False, ORACLE_LIVE="1")


def step_thorough(tally):
    """Statistical tests with all their samples (tests/effort.h), of which other runs take a quarter."""
    if build(tally, "release"):
        test(tally, "release", "--label-regex", "^(kernel|render|slow|unit)$", batches=False, WAVECREST_THOROUGH="1")


# Unit and kernel tests, and the sessions, with fewer cases than elsewhere (tests/effort.h). Not those that render whole
# images, nor scenes_test, whose fixture generates the dragon.
SANITIZED_TESTS = (
    "allocation_test",
    "bsdf_test",
    "chains_test",
    "kernels_test",
    "load_fuzz_test",
    "load_test",
    "metrics_test",
    "session_test",
    "stages_test",
)

# On request: tables, pages and databases, which take a fifth of a sanitized build and are made of the standard library's
# containers.
SANITIZED_BENCH_TESTS = (
    "bench_report_test",
    "campaign_test",
    "claims_test",
    "compare_command_test",
    "ranks_test",
    "results_test",
)

# Sessions of all methods on several threads, with photon maps and chains. Not yet the metrics, whose loops do not say
# what TBB orders (engine/tasks/task_order.h).
THREADED_TESTS = ("library_test", "render_test", "session_test")
THREADED_CASES = "Determinism|IterationsTogether|Snapshots|StopRequest"


def sanitize(tally, targets):
    if build(tally, "asan-ubsan", "-DWAVECREST_BENCH=OFF", targets=targets):
        tests = rf"^({'|'.join(targets)})[.]batch"
        if "load_fuzz_test" in targets:
            tests += "|^fuzz[.]load$"
        test(tally, "asan-ubsan", "--tests-regex", tests, UBSAN_OPTIONS="print_stacktrace=1", WAVECREST_FUZZ_CASES="500")


def step_sanitizers(tally):
    sanitize(tally, SANITIZED_TESTS)


def step_sanitizers_bench(tally):
    sanitize(tally, SANITIZED_BENCH_TESTS)


def step_fuzz(tally):
    """Ten thousand damaged files through loader and compiler; needs no kernels, so it builds in a minute."""
    if build(tally, "asan-ubsan", "-DWAVECREST_BENCH=OFF", targets=("load_fuzz_test",)):
        test(tally, "asan-ubsan", "--tests-regex", "^fuzz[.]load[.]all$", UBSAN_OPTIONS="print_stacktrace=1")


def step_tsan(tally):
    """Data races of whatever runs on several threads (tools/tsan.supp says what is left out, and why)."""
    if build(tally, "tsan", "-DWAVECREST_BENCH=OFF", targets=THREADED_TESTS):
        options = f"suppressions='{ROOT}/tools/tsan.supp' second_deadlock_stack=1 history_size=4"
        selection = ("--tests-regex", THREADED_CASES, "--exclude-regex", "_NOT_BUILT$")
        test(tally, "tsan", *selection, batches=False, TSAN_OPTIONS=options)


def step_slurm(tally):
    """The Slurm recipe, on a cluster of this machine alone."""
    if run(tally, "slurm: packages", ["tools/install-packages", "slurm"]) and build(
        tally, "release", targets=("wavecrest",)
    ):
        test(tally, "release", "--label-regex", "^slurm$")


def step_mpi(tally):
    """Processes of Open MPI that share a render, and the ratio of their speed to that of threads."""
    if not run(tally, "mpi: packages", ["tools/install-packages", "mpi"]):
        return
    if build(tally, "release", "-DWAVECREST_MPI=ON", targets=("wavecrest",)):
        test(tally, "release", "--label-regex", "^mpi$")
        methods = ["--methods", "pt,vcm", "--seconds", "2", "--rounds", "3"]
        run(tally, "mpi: against threads", ["bench/ranks/against-threads", "build/release/wavecrest", *methods])


def step_browser(tally):
    """The viewer of pages in a headless Chromium."""
    if run(tally, "browser: packages", ["tools/install-packages", "browser"]) and build(
        tally, "release", targets=("wavecrest",)
    ):
        test(tally, "release", "--label-regex", "^browser$")


def step_wheel(tally):
    """The wheel, carrying its libraries, in a Debian 12 that has none of them. Needs root for chroot."""
    targets = ("wavecrest_python_stub", "wavecrest_scene_assets")
    if run(tally, "wheel: packages", ["tools/install-packages", "release"]) and build(
        tally, "release", *python_options(tally), targets=targets
    ):
        run(tally, "wheel", ["tests/python/wheel-test"])


def step_package(tally):
    """The Debian package in a bare Debian 12. Needs root for chroot."""
    if run(tally, "package: packages", ["tools/install-packages", "release"]):
        run(tally, "package", ["tests/install/package-test"])


def step_newcomer(tally):
    """README's commands and the tutorial's in a bare Debian 12, ./quickstart among them. Needs root for chroot."""
    if run(tally, "newcomer: packages", ["tools/install-packages", "release"]):
        run(tally, "newcomer", ["tests/docs/newcomer-test"])


def step_lint(tally):
    run(tally, "format", [sys.executable, "tools/lint.py", "format"])
    run(tally, "tidy of what changed", [sys.executable, "tools/lint.py", "tidy", "--changed"])


def step_tidy(tally):
    run(tally, "tidy", [sys.executable, "tools/lint.py", "tidy"])


STEPS = {
    "release": step_release,
    "long": step_long,
    "sanitizers": step_sanitizers,
    "sanitizers-bench": step_sanitizers_bench,
    "fuzz": step_fuzz,
    "thorough": step_thorough,
    "tsan": step_tsan,
    "lint": step_lint,
    "tidy": step_tidy,
    "python": step_python,
    "browser": step_browser,
    "mpi": step_mpi,
    "slurm": step_slurm,
    "wheel": step_wheel,
    "package": step_package,
    "newcomer": step_newcomer,
}
# To ask for: pictures of all scenes, ten thousand damaged files, four times the samples of statistical tests, data
# races, and clang-tidy over the whole tree, which take longer than all else together.
DEFAULT_STEPS = ("release", "sanitizers", "lint")


def main():
    parser = argparse.ArgumentParser(prog="check", description="Build, test and lint; ends with `N passed, N failed`.")
    parser.add_argument("--steps", default=",".join(DEFAULT_STEPS), help="comma-separated subset of " + ",".join(STEPS))
    steps = parser.parse_args().steps.split(",")
    if unknown := [step for step in steps if step not in STEPS]:
        parser.error(f"unknown step {unknown[0]!r}; expected some of {','.join(STEPS)}")

    tally = Tally()
    start = time.monotonic()
    for step in steps:
        STEPS[step](tally)

    print(f"\n=== summary after {(time.monotonic() - start) / 60:.1f} minutes")
    for name, seconds in tally.seconds.items():
        print(f"{seconds:6.0f} s  {name}")
    for name in tally.skipped:
        print(f"skipped: {name}")
    for name in tally.failed:
        print(f"FAILED: {name}")
    print(f"{len(tally.passed)} passed, {len(tally.failed)} failed", flush=True)
    sys.exit(1 if tally.failed else 0)


if __name__ == "__main__":
    main()
