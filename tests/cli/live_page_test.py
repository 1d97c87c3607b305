"""The page of `converge --view` in a headless Chromium: its curves and axes. It is put together from its files, without a campaign."""

import json
import pathlib
import tempfile
import unittest

from browser import AVAILABLE, NEEDS, Browser

ASSETS = pathlib.Path(__file__).resolve().parents[2] / "bench" / "live" / "assets"


@unittest.skipUnless(AVAILABLE, NEEDS)
class LivePage(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="wavecrest_cli_")
        self.addCleanup(folder.cleanup)
        body, *scripts = ((ASSETS / name).read_text() for name in ("campaign_view.html", "live.js", "campaign_view.js"))
        page = pathlib.Path(folder.name) / "page.html"
        page.write_text(f"<!DOCTYPE html><meta charset=\"utf-8\"><body>{body}<script>\n{''.join(scripts)}</script></body>")
        self.browser = Browser(1000, 800, pathlib.Path(folder.name))
        self.addCleanup(self.browser.close)
        self.browser.open(page.as_uri())

    def test_a_mean_is_over_snapshots_of_one_number(self):
        for curves, mean in (
            ([[[1, 1, 5], [2, 2, 4]], [[2, 2, 2]]], [[2, 3]]),
            ([[[1, 1, 5], [3, 4, 1]]], [[1, 5], [4, 1]]),
            ([[[1, 1, 5]], [[2, 2, 2]]], []),
            ([], []),
        ):
            self.assertEqual(self.browser.run("return meanCurve(arguments[0])", curves), mean)

    def test_runs_of_two_seeds_are_drawn_with_their_mean(self):
        metric = {"name": "rmse", "symbol": "RMSE", "title": "error", "higher_is_better": False}
        campaign = {
            "scenes": ["a"], "methods": [{"id": "pt", "name": "path tracing"}], "seeds": 2, "width": 4, "height": 3,
            "shard": 1, "shards": 1, "metrics": [metric],
        }  # fmt: skip
        self.send({"campaign": campaign})
        for seed, numbers in ((1, (1, 2, 3)), (2, (2, 3))):
            points = [{"number": n, "seconds": 2.0**n, "iterations": n, "values": {"rmse": 1 / n}} for n in numbers]
            self.send({"run": {"scene": "a", "method": "pt", "seed": seed, "state": "done", "reason": "", "points": points}})
        self.browser.until("document.querySelectorAll('path.curve').length === 3")
        paths = self.browser.run("return [...document.querySelectorAll('path.curve')].map((path) => path.getAttribute('d'))")
        self.assertEqual(paths[2], paths[1], "the mean has what both seeds have")
        self.assertTrue(paths[0].endswith(paths[1].removeprefix("M")), "the first seed has one snapshot before")

    def send(self, event):
        self.browser.run("onEvent(JSON.parse(arguments[0]))", json.dumps(event))

    def test_no_axis_is_without_a_tick(self):
        bare = self.browser.run(
            "const bare = [];"
            "for (let low = 0.01; low < 0.1; low *= 1.013) for (let factor = 1; factor < 2000; factor *= 1.017) {"
            "  if (!ticksOf(...rangeOf([low, low * factor], true), true).length) bare.push([low, low * factor]);"
            "}"
            "return [bare, ticksOf(...rangeOf([0.031, 0.047], true), true).length]"
        )
        self.assertEqual(bare[0], [])
        self.assertGreater(bare[1], 0)


if __name__ == "__main__":
    unittest.main()
