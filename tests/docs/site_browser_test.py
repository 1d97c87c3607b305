"""The documentation site in a headless Chromium: nothing is wider than the page, and all text can be read, light and dark."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/cli"))

from browser import AVAILABLE, NEEDS, Browser  # noqa: E402

PAGES = ["index", "gallery", "commands", "interface", "docs/tutorial", "scenes/README", "engine/methods/METHODS", "bench/peers/TABLE",
         "language/index", "language/bsdf-ward", "language/rfilter-tent", "language/film-hdrfilm"]  # fmt: skip

# Elements whose edges stand out of the window; what is within an element that scrolls or hides them does not count.
WIDER = """
  const contained = (element) => {
    for (let around = element.parentElement; around; around = around.parentElement) {
      if (getComputedStyle(around).overflowX !== 'visible' && around !== document.documentElement && around !== document.body) return true;
    }
    return false;
  };
  const width = document.documentElement.clientWidth;
  const wide = [...document.body.querySelectorAll('*')].filter((element) => {
    const box = element.getBoundingClientRect();
    return box.width > 0 && box.height > 0 && (box.right > width + 1 || box.left < -1) && !contained(element);
  }).map((element) => element.outerHTML.slice(0, 100));
  if (document.documentElement.scrollWidth > width) wide.push('the page scrolls sideways');
  return wide;
"""

# Text whose contrast with what is behind it, as WCAG 2 counts it, is less than 4.5 (3 of large text).
FAINT = """
  const channels = (colour) => colour.match(/[\\d.]+/g).map(Number);
  const luminance = (colour) => channels(colour).slice(0, 3).map((value) => value / 255)
    .map((value) => value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4)
    .reduce((sum, value, i) => sum + value * [0.2126, 0.7152, 0.0722][i], 0);
  const opacity = (colour) => channels(colour)[3] ?? 1;
  const over = (front, back) => `rgb(${[0, 1, 2].map((i) => opacity(front) * channels(front)[i] + (1 - opacity(front)) * channels(back)[i])})`;
  const behind = (element) => {
    if (!element) return 'rgb(255, 255, 255)';
    const own = getComputedStyle(element).backgroundColor;
    return opacity(own) === 1 ? own : over(own, behind(element.parentElement));
  };
  const faint = new Set();
  for (const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT); walker.nextNode();) {
    const element = walker.currentNode.parentElement, style = getComputedStyle(element);
    if (!walker.currentNode.textContent.trim() || !element.getClientRects().length || element.closest('script, style')) continue;
    const back = behind(element), pair = [luminance(over(style.color, back)), luminance(back)].sort((a, b) => b - a);
    const contrast = (pair[0] + 0.05) / (pair[1] + 0.05);
    if (contrast < (parseFloat(style.fontSize) >= 24 ? 3 : 4.5)) faint.add(`${contrast.toFixed(1)} ${element.tagName}.${element.className}: ${walker.currentNode.textContent.trim().slice(0, 40)}`);
  }
  return [...faint].slice(0, 20);
"""


@unittest.skipUnless(AVAILABLE, NEEDS)
class SiteInBrowser(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="wavecrest_docs_")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        command = [sys.executable, ROOT / "docs/build.py", "--out", cls.folder / "out", "--wavecrest", os.environ["WAVECREST"]]
        made = subprocess.run(command, capture_output=True, text=True, check=False)
        if made.returncode != 0:
            raise RuntimeError(made.stderr)
        cls.browser = Browser(1400, 900, cls.folder)
        cls.addClassCleanup(cls.browser.close)

    def open(self, page):
        self.browser.open((self.folder / "out/site" / f"{page}.html").as_uri())

    def on_each_page(self, script, message):
        for page in PAGES:
            self.open(page)
            with self.subTest(page):
                self.assertEqual(self.browser.run(script), [], message)

    def test_nothing_is_wider_than_the_page(self):
        for width in (1400, 400):
            self.browser.resize(width, 900)
            self.on_each_page(WIDER, f"at {width} pixels")

    def test_text_can_be_read_light_and_dark(self):
        self.browser.resize(1400, 900)
        for scheme in ("light", "dark"):
            self.browser.prefer(scheme)
            self.on_each_page(FAINT, scheme)
        # It is dark indeed.
        self.open("gallery")
        colour = self.browser.run("return getComputedStyle(document.body).backgroundColor.match(/\\d+/g).map(Number)")
        self.assertLess(max(colour), 64)
        self.browser.prefer("light")

    def test_the_gallery_is_linked_from_the_index_and_shows_pictures(self):
        self.open("index")
        links = self.browser.run("return [...document.querySelectorAll('[role=main] a')].filter((link) => link.href.endsWith('/gallery.html')).length")
        self.assertEqual(links, 1)
        self.open("gallery")
        pictures = self.browser.run("return [...document.querySelectorAll('figure img')].map((image) => [image.complete, image.naturalWidth])")
        self.assertGreaterEqual(len(pictures), 7 + 40)
        self.assertEqual([picture for picture in pictures if picture != [True, 320]], [])


if __name__ == "__main__":
    unittest.main()
