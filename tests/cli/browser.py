"""A headless Chromium for tests of pages, driven by WebDriver, which is HTTP and JSON. Python's standard library only."""

import json
import os
import re
import shutil
import subprocess
import tempfile
import time
import urllib.error
import urllib.request

DRIVER = shutil.which("chromedriver")
AVAILABLE = bool(DRIVER and shutil.which("chromium"))
NEEDS = "needs chromium and chromedriver: tools/install-packages browser"
ELEMENT = "element-6066-11e4-a52e-4f735466cecf"
# Of one answer of the browser, which takes part of a second: whatever hangs fails before the limit of ctest.
PATIENCE_SECONDS = 60


class Browser:
    """One page in one headless Chromium, which needs no network."""

    def __init__(self, width, height, folder):
        # No proxy stands between this process, the driver and the browser.
        self.opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
        self.log = folder / "chromedriver.log"
        # Whatever the browser leaves there goes with it.
        self.leavings = tempfile.TemporaryDirectory(prefix="wavecrest_browser_", ignore_cleanup_errors=True)
        environment = os.environ | {"TMPDIR": self.leavings.name}
        with open(self.log, "wb") as log:
            self.driver = subprocess.Popen([DRIVER, "--port=0"], stdout=log, stderr=subprocess.STDOUT, env=environment)
        try:
            self.base = f"http://127.0.0.1:{self.port()}"
            self.base += "/session/" + self.begin(width, height, folder)
        except BaseException:
            self.end_driver()
            raise

    def port(self):
        """The free one that the driver has found."""
        deadline = time.monotonic() + PATIENCE_SECONDS
        while not (told := re.search(r"started successfully on port (\d+)", self.log.read_text(errors="replace"))):
            if self.driver.poll() is not None or time.monotonic() > deadline:
                raise RuntimeError("chromedriver does not start: " + self.log.read_text(errors="replace"))
            time.sleep(0.02)
        return int(told[1])

    def begin(self, width, height, folder):
        arguments = [
            "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--disable-background-networking",
            "--no-proxy-server", "--force-device-scale-factor=1", f"--window-size={width},{height}",
        ]  # fmt: skip
        options = {"args": arguments, "prefs": {"download.default_directory": str(folder)}}
        patience = 1000 * PATIENCE_SECONDS
        capabilities = {"goog:chromeOptions": options, "timeouts": {"script": patience, "pageLoad": patience}}
        return self.ask("POST", "/session", {"capabilities": {"alwaysMatch": capabilities}})["sessionId"]

    def ask(self, method, path, content=None):
        data = None if content is None else json.dumps(content).encode()
        request = urllib.request.Request(self.base + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with self.opener.open(request, timeout=2 * PATIENCE_SECONDS) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(error.read().decode()) from error

    def open(self, url):
        self.ask("POST", "/url", {"url": url})

    def run(self, script, *arguments):
        """What the script returns, once a promise of it is kept."""
        wrapped = f"const done = arguments[arguments.length - 1]; (async () => {{ {script} }})().then(done, (error) => done('failed: ' + error))"
        result = self.ask("POST", "/execute/async", {"script": wrapped, "args": list(arguments)})
        if isinstance(result, str) and result.startswith("failed: "):
            raise RuntimeError(result)
        return result

    def find(self, selector):
        return self.ask("POST", "/element", {"using": "css selector", "value": selector})[ELEMENT]

    def until(self, condition, *arguments):
        """Waits until the expression is true in the page."""
        self.run(f"while (!({condition})) await new Promise((resolve) => setTimeout(resolve, 10));", *arguments)

    def resize(self, width, height):
        self.ask("POST", "/window/rect", {"width": width, "height": height})
        self.until("innerWidth === arguments[0]", width)

    def prefer(self, scheme):
        """Pages see a reader who prefers this colour scheme, light or dark."""
        features = [{"name": "prefers-color-scheme", "value": scheme}]
        self.ask("POST", "/goog/cdp/execute", {"cmd": "Emulation.setEmulatedMedia", "params": {"features": features}})

    def click(self, text):
        """The button of that text, by the pointer: a browser lets a script begin one download, its user each."""
        button = self.ask("POST", "/element", {"using": "xpath", "value": f"//button[normalize-space()='{text}']"})[ELEMENT]
        self.ask("POST", f"/element/{button}/click", {})

    def pointer(self, *actions):
        self.ask("POST", "/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": list(actions)}]})

    def close(self):
        try:
            self.ask("DELETE", "")
        finally:
            self.end_driver()

    def end_driver(self):
        self.driver.terminate()
        try:
            self.driver.wait(PATIENCE_SECONDS)
        except subprocess.TimeoutExpired:
            self.driver.kill()
            self.driver.wait()
        self.leavings.cleanup()
