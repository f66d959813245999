"""A real browser: Chromium without a window, driven through ChromeDriver (W3C WebDriver)."""

import base64
import json
import shutil
import subprocess
import tempfile
import urllib.error
import urllib.request

from patience import PATIENCE, free_port, wait_until

SWITCHES = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--enable-unsafe-swiftshader",
    "--window-size=1280,760",
]


class Browser:
    """A browser with one page."""

    def __init__(self):
        self.profile = tempfile.mkdtemp(prefix="opendr-browser-")
        port = free_port()
        self.driver = subprocess.Popen(
            ["chromedriver", f"--port={port}"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        self.address = f"http://127.0.0.1:{port}"
        wait_until(self.is_ready, PATIENCE, "ChromeDriver")
        options = {"args": [*SWITCHES, f"--user-data-dir={self.profile}"]}
        capabilities = {"alwaysMatch": {"goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL"}}}
        session = self.post("/session", {"capabilities": capabilities})
        self.address += f"/session/{session['sessionId']}"

    def is_ready(self):
        try:
            return self.request("GET", "/status")["ready"]
        except urllib.error.URLError:
            return False

    def request(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.address + path, data, method=method)
        request.add_header("Content-Type", "application/json")
        try:
            with urllib.request.urlopen(request, timeout=PATIENCE) as response:
                return json.load(response)["value"]
        except urllib.error.HTTPError as error:
            raise AssertionError(json.load(error)["value"]["message"]) from error

    def post(self, path, body):
        return self.request("POST", path, body)

    def open(self, url):
        """Opens a page in place of the one before, whose errors are forgotten."""
        self.post("/url", {"url": "about:blank"})
        self.errors()
        self.post("/url", {"url": url})

    def run(self, script, *arguments):
        """Returns what `script` returns in the page."""
        return self.post("/execute/sync", {"script": script, "args": list(arguments)})

    def wait(self, expression):
        """Waits until a JavaScript expression is true and returns its value."""
        return wait_until(lambda: self.run(f"return {expression}"), PATIENCE, expression)

    def screenshot(self, path):
        path.write_bytes(base64.b64decode(self.request("GET", "/screenshot")))

    def errors(self):
        """The errors of the page since the last call."""
        entries = self.post("/se/log", {"type": "browser"})
        return [entry["message"] for entry in entries if entry["level"] == "SEVERE"]

    def close(self):
        try:
            self.request("DELETE", "")
        finally:
            self.driver.terminate()
            self.driver.wait()
            shutil.rmtree(self.profile, ignore_errors=True)
