"""`--view`: the page and its events are there for who has the token, and for nobody else."""

import json
import math
import pathlib
import signal
import struct
import unittest

from harness import DONE, INTERRUPTED, USAGE, read_json, read_pfm
from view_harness import SMALL, Viewed


class ViewTest(Viewed):
    def test_the_page_is_there_for_who_has_the_token(self):
        process, page = self.started("render", *SMALL, "--time", "10m", "--view")
        self.assertEqual(page.url.hostname, "127.0.0.1")
        response, body = page.get("/")
        self.assertEqual((response.status, response.headers["Content-Type"]), (200, "text/html"))
        self.assertIn(b"<canvas", body)
        self.assertNotIn(b"http://", body.replace(b"http://www.w3.org/", b""))  # it needs nothing from elsewhere
        self.assertIn("default-src 'none'", response.headers["Content-Security-Policy"])
        for path in ("/", "/events", "/image", "/favicon.ico"):
            for query in ("", "token=", "token=" + "0" * 32, page.url.query[:-1], page.url.query + "0"):
                response, body = page.get(path, query)
                self.assertEqual(response.status, 403, (path, query))
                self.assertNotIn(page.url.query.encode(), body)
        self.assertEqual(page.get("/other")[0].status, 404)
        process.send_signal(signal.SIGINT)
        self.end(process, INTERRUPTED)

    def test_events_tell_of_the_render_to_its_end(self):
        process, page = self.started("render", *SMALL, "--spp", "40000", "--view", "0", "-o", "image.pfm")
        events = list(page.events())
        bytes_of_image = page.get("/image")[1]
        self.end(process, DONE)
        self.assertEqual(events.pop(), (None, "end"))
        self.assertEqual([number for number, _ in events], list(range(len(events))))
        facts, *looks = (event for _, event in events)
        self.assertEqual((facts["facts"]["scene"], facts["facts"]["method"]), ("cornell-diffuse", "pt"))
        seconds = [look["seconds"] for look in looks]
        self.assertEqual(seconds, sorted(seconds))
        self.assertEqual([look["last"] for look in looks], [False] * (len(looks) - 1) + [True])
        self.assertEqual((looks[-1]["iterations"], looks[-1]["fraction"]), (40000, 1))
        for look in looks[1:]:
            self.assertTrue(look["paths_per_second"] is None or look["paths_per_second"] > 0)
        errors = [look["error"] for look in looks if "error" in look]
        self.assertTrue(errors)
        for error in errors:
            self.assertTrue(0 < error["low"] < error["value"] < error["high"])
        # The error falls as the root of the iterations; intervals are at 95 %, and images of one render.
        first, last = errors[0], errors[-1]
        expected = first["value"] * math.sqrt(first["iterations"] / last["iterations"])
        self.assertTrue(expected / 2 < last["value"] < expected * 2, (first, last))

        # The image is the one that was written, in half precision.
        width, height = struct.unpack_from("<II", bytes_of_image)
        shown = struct.unpack_from(f"<{3 * width * height}e", bytes_of_image, 8)
        self.assertEqual(len(bytes_of_image), 8 + 6 * width * height)
        file_width, file_height, values = read_pfm(self.path("image.pfm"))
        self.assertEqual((width, height), (file_width, file_height))
        for y in range(height):
            for i in range(3 * width):
                value = values[3 * width * (height - 1 - y) + i]
                self.assertAlmostEqual(shown[3 * width * y + i], value, delta=value * 2**-11 + 2**-25)

    def test_a_reader_that_comes_back_gets_what_it_has_not_had(self):
        process, page = self.started("render", *SMALL, "--time", "10m", "--view")
        stream = page.events()
        while (number := next(stream)[0]) < 2:
            pass
        self.assertEqual(next(page.events(last=number - 1))[0], number)
        process.send_signal(signal.SIGINT)
        self.end(process, INTERRUPTED)

    def test_images_are_the_same_with_and_without(self):
        for method in ("pt", "bpt", "ppm", "mlt"):
            self.render("-m", method, "--spp", "40", "-o", f"{method}.pfm")
            self.render("-m", method, "--spp", "40", "--view", "-o", f"{method}-view.pfm")
            plain, shown = (pathlib.Path(self.path(f"{method}{end}.pfm")).read_bytes() for end in ("", "-view"))
            self.assertEqual(plain, shown, method)

    def test_chains_are_looked_at_before_they_start_and_where_their_steps_are_long(self):
        # A bootstrap longer than the time before the first look, and steps of a quarter of the render's time.
        for arguments in (("--spp", "4", "--bootstrap", "1000000"), ("--time", "2s", "--chains", "400000")):
            self.render("-m", "mlt", *arguments, "--view", "-o", "image.pfm", "--stats", "stats.json")
            stats = read_json(self.path("stats.json"))
            self.assertGreater(stats["iterations"], 0)
            if "--time" in arguments:
                self.assertGreater(stats["render_seconds"], 1)

    def test_the_address_is_told_in_every_kind_of_progress(self):
        self.assertIn("view: http://", self.render("--spp", "1", "--view", "--progress", "none").stderr)
        lines = self.render("--spp", "1", "--view", "--progress", "jsonl").stderr.splitlines()
        self.assertTrue(any(json.loads(line).get("view", "").startswith("http://127.0.0.1:") for line in lines))

    def test_a_port_that_is_taken_or_makes_no_sense_is_refused(self):
        process, page = self.started("render", *SMALL, "--time", "10m", "--view")
        taken = self.render("--view", str(page.url.port), "--spp", "1", expect=USAGE)
        self.assert_one_error_line(taken, rf"--view 127\.0\.0\.1:{page.url.port}: .*free port")
        # An address of documentation, which no machine has.
        elsewhere = self.render("--view", "192.0.2.1:0", "--spp", "1", expect=USAGE)
        self.assert_one_error_line(elsewhere, r"--view 192\.0\.2\.1:0: .*: Cannot assign .*; expected an address of this")
        for word in ("cornell-mirror", "65536", "-1", "a:b:80"):
            self.assertIn("PORT", self.render(f"--view={word}", expect=USAGE).stderr)
        process.kill()

    def test_a_campaign_shows_its_runs_as_they_come(self):
        arguments = ["--methods", "pt,bpt", "--spp", "4", "--size", "32x24", "--seeds", "2", "--out", "out", "--threads", "2"]
        process, page = self.started("converge", "cornell-diffuse", *arguments, "--view")
        self.assertIn(b"wavecrest converge", page.get("/")[1])
        events = [event for _, event in page.events()]
        self.end(process, DONE)
        self.assertEqual(events.pop(), "end")
        campaign = events[0]["campaign"]
        self.assertEqual(campaign["scenes"], ["cornell-diffuse"])
        self.assertEqual([method["id"] for method in campaign["methods"]], ["pt", "bpt"])
        names = [metric["name"] for metric in campaign["metrics"]]
        self.assertIn("ssim", names)
        self.assertNotIn("hdrflip", names)  # which campaigns do not measure
        runs = [event["run"] for event in events if "run" in event]
        self.assertEqual(
            [(run["method"], run["seed"]) for run in runs], [("pt", 1), ("bpt", 1), ("pt", 2), ("bpt", 2)]
        )
        for run in runs:
            self.assertEqual([(point["number"], point["iterations"]) for point in run["points"]], [(0, 1), (1, 2), (2, 4)])
            self.assertTrue(all(point["values"]["rmse"] > 0 for point in run["points"]))
        progress = [event["progress"] for event in events if "progress" in event]
        self.assertEqual([p["done"] for p in progress], [1, 2, 3, 4])
        self.assertEqual(events[-1], {"end": {"complete": True}})

        # Runs of earlier processes are shown as well.
        process, page = self.started("converge", "--out", "out", "--resume", "--seeds", "3", "--view")
        events = [event for _, event in page.events()]
        self.end(process, DONE)
        self.assertEqual(len([event for event in events if "run" in event]), 6)
        self.assertEqual(next(event["plan"] for event in events if "plan" in event)["done"], 4)


if __name__ == "__main__":
    unittest.main()
