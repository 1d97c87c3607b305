"""What became of each test case, out of ctest's JUnit file and of those that GoogleTest wrote for batches.

A batch is one test of ctest and many cases (tests/CMakeLists.txt). Cases of a batch that has not come to its end, as it crashed or
took too long, are read from its output: the one that was running failed, and each that was not yet run is a failure as well.
"""

import dataclasses
import re
import xml.etree.ElementTree as ElementTree


@dataclasses.dataclass
class Case:
    name: str
    outcome: str  # passed, skipped or failed
    why: str = ""
    said: list = dataclasses.field(default_factory=list)  # lines


def read(report, batches):
    """Cases of ctest's file `report`; BATCH.xml in the folder `batches` has those of a test of that name."""
    for test in ElementTree.parse(report).getroot().iter("testcase"):
        whole = whole_test(test)
        if not re.search(r"[.]batch\d+$", whole.name):
            yield whole
            continue
        path = batches / f"{whole.name}.xml"
        if whole.outcome == "passed" and not path.exists():  # GoogleTest writes one of a batch without cases, too
            yield Case(whole.name, "failed", "ended with code 0 before its cases did")
            continue
        cases = list(ended_batch(path) if path.exists() else broken_batch(whole))
        yield from cases
        if whole.outcome != "passed" and all(case.outcome != "failed" for case in cases):
            yield whole  # a leak, or a crash on the way out


def whole_test(test):
    """A test of ctest."""
    skipped = test.find("skipped")
    reason = skipped.get("message", "") if skipped is not None else ""
    said = (test.findtext("system-out") or "").rstrip().splitlines()
    if test.get("status") == "run":
        return Case(test.get("name"), "passed")
    if test.get("status") == "disabled" or reason.startswith("SKIP_"):
        return Case(test.get("name"), "skipped", reason)
    return Case(test.get("name"), "failed", reason, said)


def ended_batch(path):
    """The cases of a batch that GoogleTest wrote a file about."""
    for case in ElementTree.parse(path).getroot().iter("testcase"):
        name = f"{case.get('classname')}.{case.get('name')}"
        if failures := case.findall("failure"):
            yield Case(name, "failed", said=[line for each in failures for line in (each.text or "").splitlines()])
        else:
            yield Case(name, "passed" if case.get("result") == "completed" else "skipped")


def broken_batch(whole):
    """The cases of a batch without such a file, out of what it printed."""
    ended, running, count = 0, "", 0
    for i, line in enumerate(whole.said):
        if match := re.match(r"\[=+\] Running (\d+) tests? from", line):
            count = int(match[1])
        elif match := re.match(r"\[ RUN +\] (\S+)", line):
            running, start = match[1], i
        elif running and (match := re.search(r"\[ +(OK|FAILED|SKIPPED) +\] " + re.escape(running), line)):
            outcome = {"OK": "passed", "FAILED": "failed", "SKIPPED": "skipped"}[match[1]]
            yield Case(running, outcome, said=whole.said[start:i])
            ended, running = ended + 1, ""
    if running:
        yield Case(running, "failed", whole.why or "ended its batch", whole.said[start:])
        ended += 1
    for i in range(ended, count):
        yield Case(f"{whole.name}, case {i + 1} of {count}", "failed", "not run, as the batch ended before it")
