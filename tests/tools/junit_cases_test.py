"""tools/junit_cases.py: each case of a batch counts, whether the batch came to its end or not."""

import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))

import junit_cases  # noqa: E402  (the path has to be set first)

ENDED = """<testsuites><testsuite name="A">
<testcase classname="A" name="holds" status="run" result="completed"/>
<testcase classname="A" name="isSkipped" status="run" result="skipped"><skipped/></testcase>
<testcase classname="A" name="isOff" status="notrun" result="suppressed"/>
<testcase classname="A" name="breaks" status="run" result="completed"><failure>1 is not 2</failure></testcase>
</testsuite></testsuites>"""
HELD = '<testsuites><testcase classname="A" name="holds" status="run" result="completed"/></testsuites>'
CRASHED = """[==========] Running 5 tests from 1 test suite.
[ RUN      ] A.holds
[       OK ] A.holds (0 ms)
[ RUN      ] A.breaks
1 is not 2
[  FAILED  ] A.breaks (0 ms)
[ RUN      ] A.crashes
ERROR: AddressSanitizer"""


class Cases(unittest.TestCase):
    def outcomes(self, test, batch=None):
        """(name, outcome) of all cases of one test of ctest, whose batch wrote this file."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "junit.xml").write_text(f"<testsuite>{test}</testsuite>")
            if batch:
                (folder / "a_test.batch0.xml").write_text(batch)
            self.cases = list(junit_cases.read(folder / "junit.xml", folder))
        return [(case.name, case.outcome) for case in self.cases]

    def test_a_test_that_is_no_batch_is_one_case(self):
        self.assertEqual(self.outcomes('<testcase name="cli.render" status="run"/>'), [("cli.render", "passed")])
        self.assertEqual(self.outcomes('<testcase name="cli.render" status="fail"/>'), [("cli.render", "failed")])
        absent = '<testcase name="cli.render" status="notrun"><skipped message="Unable to find executable"/></testcase>'
        self.assertEqual(self.outcomes(absent), [("cli.render", "failed")])
        skipped = '<testcase name="cli.render" status="notrun"><skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/></testcase>'
        self.assertEqual(self.outcomes(skipped), [("cli.render", "skipped")])

    def test_a_batch_is_its_cases(self):
        expected = [("A.holds", "passed"), ("A.isSkipped", "skipped"), ("A.isOff", "skipped"), ("A.breaks", "failed")]
        self.assertEqual(self.outcomes('<testcase name="a_test.batch0" status="fail"/>', ENDED), expected)
        self.assertEqual(self.cases[-1].said, ["1 is not 2"])

    def test_a_batch_that_fails_after_its_cases_is_a_failure(self):
        expected = [("A.holds", "passed"), ("a_test.batch0", "failed")]
        self.assertEqual(self.outcomes('<testcase name="a_test.batch0" status="fail"/>', HELD), expected)

    def test_after_a_crash_cases_that_were_not_run_are_failures(self):
        crashed = f'<testcase name="a_test.batch0" status="fail"><system-out>{CRASHED}</system-out></testcase>'
        outcomes = self.outcomes(crashed)
        self.assertEqual(outcomes[:3], [("A.holds", "passed"), ("A.breaks", "failed"), ("A.crashes", "failed")])
        self.assertEqual([outcome for _, outcome in outcomes[3:]], ["failed", "failed"])
        self.assertEqual(self.cases[2].said, ["[ RUN      ] A.crashes", "ERROR: AddressSanitizer"])

    def test_a_batch_that_ends_well_before_its_cases_is_a_failure(self):
        passed = '<testcase name="a_test.batch0" status="run"/>'
        self.assertEqual(self.outcomes(passed), [("a_test.batch0", "failed")])
        self.assertEqual(self.outcomes(passed, "<testsuites/>"), [])  # a batch that has no cases

    def test_a_batch_that_was_not_built_is_a_failure(self):
        absent = '<testcase name="a_test.batch0" status="notrun"><skipped message="Unable to find executable"/></testcase>'
        self.assertEqual(self.outcomes(absent), [("a_test.batch0", "failed")])


if __name__ == "__main__":
    unittest.main()
