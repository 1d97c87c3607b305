"""The viewer of `compare --html` and of reports in a headless Chromium: floats behind the pictures.

Expected values come from the images that were compared, read here by code that shares nothing with the page or the program.
"""

import base64
import math
import pathlib
import re
import shutil
import struct
import time
import unittest
from xml.etree import ElementTree

from browser import AVAILABLE, ELEMENT, NEEDS, PATIENCE_SECONDS, Browser
from harness import CommandTest, read_pfm


def half(value):
    """The nearest number of eleven bits."""
    if value == 0:
        return 0
    exponent = max(math.frexp(value)[1], -13)
    return round(value * 2 ** (11 - exponent)) / 2 ** (11 - exponent)


def srgb(light):
    """The code of light from 0 to 1, not yet rounded."""
    return 255 * (12.92 * light if light <= 0.0031308 else 1.055 * light ** (1 / 2.4) - 0.055)


def top_down(name):
    width, height, values = read_pfm(name)
    rows = [values[3 * width * y : 3 * width * (y + 1)] for y in range(height)]
    return width, height, [value for row in reversed(rows) for value in row]


@unittest.skipUnless(AVAILABLE, NEEDS)
class ViewerTest(CommandTest):
    SIZE = "48x32"

    def setUp(self):
        super().setUp()
        for name, spp in (("reference", 64), ("noisy", 1), ("better", 8)):
            self.run_wavecrest("render", "cornell-diffuse", "--size", self.SIZE, "--spp", spp, "--seed", spp, "-o", f"{name}.pfm", "--quiet")  # fmt: skip
        self.browser = Browser(1400, 1000, self.folder)
        self.addCleanup(self.browser.close)

    def open_comparison(self, *options):
        self.run_wavecrest("compare", "reference.pfm", "noisy.pfm", "better.pfm", "--html", "page.html", "--metrics", "rmse,relmse", *options)
        self.browser.open((self.folder / "page.html").as_uri())

    def open_times(self):
        """A report of two methods at two times each."""
        (self.folder / "images").mkdir()
        for name, spp in (("reference", 64), ("pt.1", 1), ("pt.4", 4), ("lt.2", 2), ("lt.4", 4)):
            self.run_wavecrest("render", "cornell-diffuse", "--size", self.SIZE, "--spp", spp, "-m", name.split(".")[0].replace("reference", "pt"),
                               "-o", f"images/{name}.{'exr' if name == 'reference' else 'pfm'}", "--quiet")  # fmt: skip
        self.run_wavecrest("report", "images")
        self.browser.open((self.folder / "images/report.html").as_uri())

    def slide(self, selector, value):
        script = "const slider = document.querySelector(arguments[0]); slider.value = arguments[1]; slider.dispatchEvent(new Event('input'))"
        self.browser.run(script, selector, value)

    def key(self, key, **modifiers):
        """Whether the viewer has taken the key."""
        script = (
            "const event = new KeyboardEvent('keydown', { cancelable: true, ...arguments[0] });"
            "document.querySelector('.viewer').dispatchEvent(event); return event.defaultPrevented"
        )
        return self.browser.run(script, {"key": key, **modifiers})

    def floats(self):
        """The floats of each pane as the page has read them."""
        return self.browser.run(
            "const panes = [...document.querySelectorAll('.pane[data-floats]')];"
            "for (const pane of panes) pane.read = await decodeFloats(await floatText(pane.dataset.floats), +pane.dataset.width, +pane.dataset.height);"
            "return panes.map((pane) => [pane.dataset.name, [...pane.read]])"
        )

    def test_floats_are_those_of_the_images(self):
        self.open_comparison()
        panes = self.floats()
        self.assertEqual([name for name, _ in panes], ["reference", "noisy", "better"])
        for name, values in panes:
            _, _, expected = top_down(self.path(f"{name}.pfm"))
            self.assertEqual(values, [half(value) for value in expected], name)

    def test_exposure_luminance_and_wipe(self):
        self.open_comparison()
        canvas = "document.querySelectorAll('.pane')[1].querySelector('canvas.light')"
        pixel = f"return [...{canvas}.getContext('2d').getImageData(20, 20, 1, 1).data]"
        self.assertFalse(self.browser.run(f"return Boolean({canvas})"))
        self.slide(".floats input", 2)
        self.browser.until(canvas)
        width, _, values = top_down(self.path("noisy.pfm"))
        at = 3 * (20 * width + 20)
        self.assertIn("+2 EV", self.browser.run("return document.querySelector('.floats label output').textContent"))
        bright = self.browser.run(pixel)
        for code, value in zip(bright, values[at : at + 3]):
            self.assertLess(abs(code - srgb(min(max(4 * half(value), 0), 1))), 1)
        # The wipe shows the reference as exposed.
        self.browser.click("Wipe")
        self.assertEqual(self.browser.run("return document.querySelectorAll('.over canvas').length"), 1)
        self.browser.click("Side by side")
        self.browser.click("Luminance")
        self.browser.until("document.querySelector('.values output').textContent.startsWith('luminance')")
        self.assertNotEqual(self.browser.run(pixel), bright)
        # Back to the pictures of the page. Arrows are the slider's while it has the focus.
        self.browser.click("Luminance")
        self.browser.run("document.querySelector('.floats input').dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowLeft', bubbles: true }))")
        self.assertFalse(self.browser.run("return document.querySelector('.viewer').classList.contains('flip')"))
        self.browser.run("document.querySelector('.viewer').dispatchEvent(new KeyboardEvent('keydown', { key: '0' }))")
        self.browser.until(f"!{canvas}")

    def test_codes_are_the_nearest(self):
        self.open_comparison()
        codes = self.browser.run("return [...srgbCodes]")
        self.assertEqual(len(codes), 4097)
        for i, code in enumerate(codes):
            self.assertLess(abs(code - srgb(i / 4096)), 0.5 + 1e-9, i)

    def test_the_slider_adds_to_the_exposure_of_the_comparison(self):
        self.open_comparison("--exposure", 2)
        canvas = "document.querySelectorAll('.pane')[1].querySelector('canvas.light')"
        self.slide(".floats input", 1)
        self.browser.until(canvas)
        width, _, values = top_down(self.path("noisy.pfm"))
        at = 3 * (20 * width + 20)
        codes = self.browser.run(f"return [...{canvas}.getContext('2d').getImageData(20, 20, 1, 1).data]")
        for code, value in zip(codes, values[at : at + 3]):
            self.assertLess(abs(code - srgb(min(max(8 * half(value), 0), 1))), 1)
        self.browser.click("Luminance")
        text = "document.querySelector('.values output').textContent"
        self.browser.until(f"{text}.startsWith('luminance')")
        self.assertIn("from 0.00195 (dark) to 2 (white)", self.browser.run(f"return {text}"))

    def test_pixels_that_are_no_numbers_have_a_luminance(self):
        name = self.path("noisy.pfm")
        data = bytearray(pathlib.Path(name).read_bytes())
        data[-12:] = struct.pack("<3f", math.nan, math.inf, -math.inf)
        pathlib.Path(name).write_bytes(data)
        self.open_comparison()
        self.browser.click("Luminance")
        self.browser.until("document.querySelectorAll('canvas.light').length === 3")

    def test_floats_need_a_reference_with_floats(self):
        self.run_wavecrest("render", "cornell-diffuse", "--size", self.SIZE, "--spp", 4, "-o", "codes.png", "--quiet")
        self.run_wavecrest("compare", "codes.png", "noisy.pfm", "--html", "page.html", "--metrics", "rmse")
        self.browser.open((self.folder / "page.html").as_uri())
        counts = "return [document.querySelectorAll('.ready .frame').length > 1, document.querySelectorAll('.floats, [data-floats]').length]"
        self.assertEqual(self.browser.run(counts), [True, 0])

    def test_a_crop_has_errors_of_its_own_and_is_exported(self):
        self.open_comparison()
        self.browser.click("Crop")
        self.browser.until("[...document.querySelectorAll('.pane[data-floats]')].every((pane) => pane.image)")
        self.browser.run("document.querySelector('.viewer').scrollIntoView()")
        frame = self.browser.find(".pane .frame")
        box = self.browser.run("const box = document.querySelector('.frame').getBoundingClientRect(); return [box.width, box.height]")
        width, height, _ = top_down(self.path("reference.pfm"))

        def move(x, y):
            # From the middle of the frame to the middle of a pixel.
            offset = lambda pixel, count, size: round((pixel + 0.5) / count * size - size / 2)  # noqa: E731
            return {"type": "pointerMove", "origin": {ELEMENT: frame}, "x": offset(x, width, box[0]), "y": offset(y, height, box[1])}

        self.browser.pointer(move(5, 4), {"type": "pointerDown", "button": 0}, move(20, 11), {"type": "pointerUp", "button": 0})
        text = self.browser.run("return document.querySelector('.crop-result').innerText")
        self.assertIn("16 × 8 pixels at (5, 4)", text)
        # Values of the pixel under the pointer.
        values = self.browser.run("return document.querySelector('.values output').textContent")
        self.assertTrue(values.startswith("(20, 11)  reference "), values)
        reference = top_down(self.path("reference.pfm"))[2]
        for name in ("noisy", "better"):
            test = top_down(self.path(f"{name}.pfm"))[2]
            pairs = [
                (half(test[i]), half(reference[i]))
                for y in range(4, 12) for i in range(3 * (y * width + 5), 3 * (y * width + 21))
            ]  # fmt: skip
            rmse = (sum((x - r) ** 2 for x, r in pairs) / len(pairs)) ** 0.5
            relmse = sum((x - r) ** 2 / (r * r + 0.01) for x, r in pairs) / len(pairs)
            shown = re.search(rf"{name}\s+(\S+)\s+(\S+)\s+(\S+)", text)
            self.assertAlmostEqual(float(shown[1]) / rmse, 1, delta=0.006)
            self.assertAlmostEqual(float(shown[2]) / relmse, 1, delta=0.006)
        for button, file, begin in (("PNG", "crop.png", b"\x89PNG"), ("SVG", "crop.svg", b"<svg "), ("LaTeX", "crop.tex", b"\\begin{tabular}")):
            self.browser.click(button)
            self.wait_for_download(file)
            self.assertTrue((self.folder / file).read_bytes().startswith(begin), file)
        names = {"svg": "http://www.w3.org/2000/svg"}
        figure = ElementTree.parse(self.folder / "crop.svg").getroot()
        self.assertEqual([label.text.split(":")[0] for label in figure.findall("svg:text", names)], ["reference", "noisy", "better"])
        for image in figure.findall("svg:image", names):
            picture = base64.b64decode(image.get("href").removeprefix("data:image/png;base64,"))
            self.assertEqual(struct.unpack_from(">II", picture, 16), (16, 8))

    def test_thin_crops_and_odd_names_are_exported(self):
        for name, seed in (("tall", 1), ("a~b_c", 2)):
            self.run_wavecrest("render", "cornell-diffuse", "--size", "24x400", "--spp", 1, "--seed", seed, "-o", f"{name}.pfm", "--quiet")
        self.run_wavecrest("compare", "tall.pfm", "a~b_c.pfm", "--html", "page.html", "--metrics", "rmse,relmse")
        self.browser.open((self.folder / "page.html").as_uri())
        is_image, table = self.browser.run(
            "const tools = new Viewer(document.querySelector('.viewer')).floats; await tools.load();"
            "tools.setCrop([3, 0], [3, 399]);"
            "return [Boolean(await new Promise((done) => tools.figure().toBlob(done))), tools.latex()]"
        )
        self.assertTrue(is_image)
        self.assertIn("  a\\textasciitilde{}b\\_c & ", table)

    def test_without_its_floats_a_page_claims_nothing(self):
        self.open_times()
        shutil.rmtree(self.folder / "images/report.floats")
        self.browser.run("window.rejections = []; addEventListener('unhandledrejection', (event) => rejections.push(String(event.reason)))")
        says_so = "document.querySelector('.values output').textContent.endsWith('is not there')"
        claims = (
            "return [document.querySelector('.floats label output').textContent, document.querySelectorAll('.cropping, canvas.light').length,"
            "[...document.querySelectorAll('.floats button')].map((button) => button.ariaPressed), rejections]"
        )
        for key in "eeelc":
            self.key(key)
            self.browser.until(says_so)
            self.assertEqual(self.browser.run(claims), ["0 EV", 0, ["false", "false"], []], key)
        self.slide(".tools .time", 0)
        self.browser.until(says_so)
        self.assertEqual(self.browser.run(claims), ["0 EV", 0, ["false", "false"], []])

    def test_shortcuts_and_further_buttons_are_the_browsers(self):
        self.open_comparison()
        self.assertTrue(self.key("ArrowLeft"))
        for key in ("ArrowLeft", "d", "1", "+"):
            for modifier in ("altKey", "ctrlKey", "metaKey"):
                self.assertFalse(self.key(key, **{modifier: True}), f"{modifier} {key}")
        self.assertFalse(self.browser.run("return document.querySelector('.viewer').classList.contains('zoomed')"))
        self.browser.click("Side by side")
        self.browser.click("2×")
        self.browser.run("document.querySelector('.viewer').scrollIntoView()")
        place = {"type": "pointerMove", "origin": {ELEMENT: self.browser.find(".pane .frame")}, "x": 0, "y": 0}
        views = []
        for button in (1, 0):
            down, up = ({"type": kind, "button": button} for kind in ("pointerDown", "pointerUp"))
            views.append(self.browser.run("return document.querySelector('.frame img').style.transform"))
            self.browser.pointer(place, down, place | {"x": 30}, up)
        views.append(self.browser.run("return document.querySelector('.frame img').style.transform"))
        self.assertEqual(views[0], views[1], "the middle button does not drag")
        self.assertNotEqual(views[1], views[2])

    def test_print_shows_whole_pictures(self):
        self.open_comparison()
        self.slide(".floats input", 2)
        self.browser.until("document.querySelector('canvas.light')")
        self.browser.click("4×")
        self.browser.click("Wipe")
        self.browser.ask("POST", "/goog/cdp/execute", {"cmd": "Emulation.setEmulatedMedia", "params": {"media": "print"}})
        for element in (".frame img", "canvas.light"):
            self.assertEqual(self.browser.run("return getComputedStyle(document.querySelector(arguments[0])).transform", element), "none")
        self.assertEqual(self.browser.run("return getComputedStyle(document.querySelector('.over')).display"), "none")

    def wait_for_download(self, file):
        deadline = time.monotonic() + PATIENCE_SECONDS
        while not (self.folder / file).exists() or list(self.folder.glob("*.crdownload")):
            self.assertLess(time.monotonic(), deadline, f"{file} is not downloaded")
            time.sleep(0.02)

    def test_a_report_reads_floats_beside_it(self):
        (self.folder / "images").mkdir()
        for name, spp in (("reference", 64), ("pt.1", 1), ("pt.4", 4), ("lt.1", 1)):
            self.run_wavecrest("render", "cornell-diffuse", "--size", self.SIZE, "--spp", spp, "-m", name.split(".")[0].replace("reference", "pt"),
                               "-o", f"images/{name}.exr", "--quiet")  # fmt: skip
        self.run_wavecrest("report", "images")
        self.browser.open((self.folder / "images/report.html").as_uri())
        panes = self.floats()
        self.assertEqual(panes[0][0], "reference")
        self.assertGreaterEqual(len(panes), 3)
        self.run_wavecrest("render", "cornell-diffuse", "--size", self.SIZE, "--spp", 64, "-o", "same.pfm", "--quiet")
        self.assertEqual(panes[0][1], [half(value) for value in top_down(self.path("same.pfm"))[2]])
        # A click on a picture asks for the values.
        self.browser.run("document.querySelector('.viewer').scrollIntoView()")
        middle = {"type": "pointerMove", "origin": {ELEMENT: self.browser.find(".pane .frame")}, "x": 0, "y": 0}
        self.browser.pointer(middle, {"type": "pointerDown", "button": 0}, {"type": "pointerUp", "button": 0})
        self.browser.until("document.querySelector('.pane[data-floats]').image")
        self.browser.pointer(middle | {"x": 3})
        values = self.browser.run("return document.querySelector('.values output').textContent")
        self.assertRegex(values, r"^\(\d+, \d+\)  reference ")

    def test_a_campaigns_crops_have_buttons(self):
        self.run_wavecrest("converge", "cornell-diffuse", "cornell-mirror", "--methods", "pt,lt", "--spp", 2, "--size", self.SIZE, "--out", "out",
                           "--crop", "cornell-mirror:3,2,16x8", "--crop", "cornell-diffuse:9,7,4x5", "--progress", "none")  # fmt: skip
        self.browser.open((self.folder / "out/report.html").as_uri())
        for viewer, other, crop in ((0, 1, "Crop 4 × 5 at (9, 7)"), (1, 0, "Crop 16 × 8 at (3, 2)")):
            buttons = f"[...document.querySelectorAll('.viewer')[{viewer}].querySelectorAll('button')].filter((one) => one.textContent === '{crop}')"
            self.assertEqual(self.browser.run(f"return {buttons}.length"), 1)
            self.assertEqual(self.browser.run(f"return {buttons.replace(f'[{viewer}]', f'[{other}]')}.length"), 0)
            self.browser.run(f"{buttons}[0].click()")
            self.browser.until(f"!document.querySelectorAll('.crop-result')[{viewer}].hidden")
            text = self.browser.run(f"return document.querySelectorAll('.crop-result')[{viewer}].innerText")
            self.assertIn(crop.removeprefix("Crop ").replace(" at", " pixels at"), text)
            self.assertRegex(text, r"pt\s+\d\S*\s+\d\S*\s+\d")

    def test_values_are_those_of_the_time_on_show(self):
        self.open_times()
        panes = "[...document.querySelectorAll('.panes:not(.away) .pane[data-floats]')]"
        self.browser.run("document.querySelector('.viewer').scrollIntoView()")

        def values_at(x, *actions):
            place = {"type": "pointerMove", "origin": {ELEMENT: self.browser.find(".panes:not(.away) .frame")}, "x": x, "y": 0}
            self.browser.pointer(place, *actions)
            return self.browser.run("return document.querySelector('.values output').textContent")

        values_at(0, {"type": "pointerDown", "button": 0}, {"type": "pointerUp", "button": 0})
        self.browser.until(f"{panes}.every((pane) => pane.image)")
        at_end = values_at(3)
        self.assertRegex(at_end, r"^\(\d+, \d+\)  reference ")
        # Neither exposed nor clicked.
        self.slide(".tools .time", 0)
        self.assertNotEqual(self.browser.run("return document.querySelector('.values output').textContent"), at_end)
        self.browser.until(f"{panes}.every((pane) => pane.image)")
        earlier = values_at(4)
        self.assertRegex(earlier, r"^\(\d+, \d+\)  reference ")
        x, y = map(int, re.match(r"\((\d+), (\d+)\)", earlier).groups())
        self.run_wavecrest("render", "cornell-diffuse", "--size", self.SIZE, "--spp", 1, "-m", "pt", "-o", "first.pfm", "--quiet")
        width, _, values = top_down(self.path("first.pfm"))
        shown = re.search(r"pt (\S+) (\S+) (\S+)", earlier).groups()
        for text, value in zip(shown, values[3 * (y * width + x) :]):
            self.assertAlmostEqual(float(text), half(value), delta=0.006 * half(value))

    def test_a_slider_shows_the_pictures_of_earlier_times(self):
        self.open_times()
        shown = (
            "return [...document.querySelectorAll('.viewer .panes:not(.away) .pane')]"
            ".map((pane) => [pane.dataset.name, pane.querySelector('figcaption').textContent])"
        )
        at_end = [["reference", "reference"], ["lt", "lt, 4 s"], ["pt", "pt, 4 s"]]
        self.assertEqual(sorted(self.browser.run(shown)), sorted(at_end))
        self.slide(".tools .time", 0)
        earlier = self.browser.run(shown)
        self.assertEqual(earlier[0][0], "reference")
        self.assertEqual(sorted(row[1] for row in earlier[1:]), ["lt, 2 s", "pt, 1 s"])
        self.assertEqual(self.browser.run("return document.querySelector('.tools .time + output').textContent"), "1 s")
        # Floats, exposure and back to the end.
        self.slide(".floats input", 2)
        self.browser.until("document.querySelectorAll('.panes:not(.away) canvas.light').length === 3")
        self.run_wavecrest("render", "cornell-diffuse", "--size", self.SIZE, "--spp", 1, "-m", "pt", "-o", "first.pfm", "--quiet")
        values = self.browser.run(
            "return [...document.querySelector('.panes:not(.away) .pane[data-name=pt]').image.floats]"
        )
        self.assertEqual(values, [half(value) for value in top_down(self.path("first.pfm"))[2]])
        self.browser.run("document.querySelector('.viewer').dispatchEvent(new KeyboardEvent('keydown', { key: 't' }))")
        self.assertEqual(sorted(self.browser.run(shown)), sorted(at_end))
        self.browser.until("document.querySelectorAll('.panes:not(.away) canvas.light').length === 3")
        # Neutral again, at whatever time.
        self.browser.run("document.querySelector('.viewer').dispatchEvent(new KeyboardEvent('keydown', { key: '0' }))")
        self.slide(".tools .time", 0)
        self.browser.until("document.querySelectorAll('.panes:not(.away) canvas.light').length === 0")
        # Maps are those of the end, and pictures come back at the time that was chosen.
        self.browser.click("Error maps")
        self.assertEqual([row[0] for row in self.browser.run(shown)].count("reference"), 0)
        self.browser.click("Pictures")
        self.assertEqual(self.browser.run(shown), earlier)

    def test_nothing_is_wider_than_the_page_nor_moves(self):
        top = "return document.querySelector('.pane .frame').getBoundingClientRect().top"
        for width in (1400, 900, 700, 400):
            self.open_comparison()
            self.browser.resize(width, 900)
            self.browser.click("Crop")
            self.browser.until("[...document.querySelectorAll('.pane[data-floats]')].every((pane) => pane.image)")
            frame = {ELEMENT: self.browser.find(".pane .frame")}
            self.browser.run("document.querySelector('.viewer').scrollIntoView()")
            place = {"type": "pointerMove", "origin": frame, "x": 0, "y": 0}
            before = self.browser.run(top)
            self.browser.pointer(place, {"type": "pointerDown", "button": 0}, place | {"x": 20, "y": 20}, {"type": "pointerUp", "button": 0})
            self.assertEqual(self.browser.run(top), before, "pictures moved under the pointer")
            for element in ("documentElement", "querySelector('.crop-result')"):
                widths = self.browser.run(f"const element = document.{element}; return [element.scrollWidth, element.clientWidth]")
                self.assertGreater(widths[1], 0, element)
                self.assertLessEqual(widths[0], widths[1], f"{element} at {width}")


if __name__ == "__main__":
    unittest.main()
