"""WebKit for tests: the MiniBrowser of WebKitGTK, driven by its WebDriver over HTTP, on a screen that is not there."""

from __future__ import annotations

import base64
import http.client
import json
import os
import shutil
import socket
import subprocess
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest


def _started(command: Sequence[str], **environment: str) -> subprocess.Popen[bytes]:
    return subprocess.Popen(
        command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env={**os.environ, **environment}
    )


class WebKit:
    """One WebKit with one page; skips the test where there is none."""

    def __init__(self) -> None:
        driver, screen = shutil.which("WebKitWebDriver"), shutil.which("Xvfb")
        browsers = sorted(Path("/usr/lib").glob("*/webkit2gtk-4.*/MiniBrowser"))
        if driver is None or screen is None or not browsers:
            pytest.skip("no WebKit here; Debian: apt-get install webkit2gtk-driver xvfb")
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self._port = free.getsockname()[1]
        number = f":{90 + self._port % 900}"
        self._processes = [_started([screen, number, "-screen", "0", "1400x900x24", "-nolisten", "tcp"])]
        self._processes.append(_started([driver, f"--port={self._port}"], DISPLAY=number, LIBGL_ALWAYS_SOFTWARE="1"))
        options = {"binary": str(browsers[-1]), "args": ["--automation"]}
        try:
            wanted = {"capabilities": {"alwaysMatch": {"webkitgtk:browserOptions": options}}}
            self._session = self._call("POST", "/session", wanted, seconds=60)["sessionId"]
        except BaseException:
            self._end()
            raise

    def _call(self, method: str, path: str, content: Any = None, seconds: float = 0.0) -> Any:
        """A command's value; for so many seconds the driver may not be there yet."""
        deadline = time.monotonic() + seconds
        while True:
            connection = http.client.HTTPConnection("127.0.0.1", self._port, timeout=240)
            try:
                connection.request(method, path, None if content is None else json.dumps(content))
                answer = json.loads(connection.getresponse().read())
                break
            except ConnectionError:
                if time.monotonic() > deadline:
                    raise
                time.sleep(0.2)
            finally:
                connection.close()
        value = answer["value"]
        assert not (isinstance(value, dict) and "error" in value), value
        return value

    def run(self, expression: str) -> Any:
        """The value of an expression in the page."""
        content = {"script": f"return {expression}", "args": []}
        return self._call("POST", f"/session/{self._session}/execute/sync", content)

    def wait(self, expression: str, seconds: float = 120.0) -> Any:
        """The expression's value as soon as it is true."""
        deadline = time.monotonic() + seconds
        while not (value := self.run(expression)):
            assert time.monotonic() < deadline, f"never came true: {expression}"
            time.sleep(0.1)
        return value

    def open(self, path: Path) -> None:
        """Open a page and wait until it is ready."""
        self._call("POST", f"/session/{self._session}/window/rect", {"width": 1280, "height": 800})
        self._call("POST", f"/session/{self._session}/url", {"url": path.resolve().as_uri()})
        self.wait("document.documentElement.dataset.ready || ''")

    def picture(self, path: Path) -> Path:
        """A screenshot."""
        path.write_bytes(base64.b64decode(self._call("GET", f"/session/{self._session}/screenshot")))
        return path

    def close(self) -> None:
        """End the browser."""
        try:
            self._call("DELETE", f"/session/{self._session}")
        finally:
            self._end()

    def _end(self) -> None:
        for process in reversed(self._processes):
            process.terminate()
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                process.kill()
