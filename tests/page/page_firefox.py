"""A headless Firefox for tests, driven by its Marionette protocol: lengths and JSON over a local socket."""

from __future__ import annotations

import base64
import json
import shutil
import socket
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Any

import pytest


class Firefox:
    """One Firefox with one page; skips the test where there is none."""

    def __init__(self) -> None:
        command = shutil.which("firefox-esr") or shutil.which("firefox")
        if command is None:
            pytest.skip("no Firefox here; Debian: apt-get install firefox-esr")
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        self._profile = tempfile.mkdtemp(prefix="page-test-")
        prefs = {
            "marionette.port": port,
            "webgl.force-enabled": True,
            "media.autoplay.default": 0,
            "app.update.enabled": False,
            "datareporting.policy.dataSubmissionEnabled": False,
            "network.proxy.type": 1,
            "network.proxy.http": "127.0.0.1",
            "network.proxy.http_port": 9,
            "network.proxy.ssl": "127.0.0.1",
            "network.proxy.ssl_port": 9,
        }
        lines = [f"user_pref({json.dumps(name)}, {json.dumps(value)});" for name, value in prefs.items()]
        (Path(self._profile) / "user.js").write_text("\n".join(lines))
        self._process = subprocess.Popen(
            [command, "--headless", "--no-remote", "--marionette", "--profile", self._profile],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        self._number = 0
        self._socket = self._connect(port)
        self._buffer = b""
        self._receive()  # the greeting
        self.call("WebDriver:NewSession")

    @staticmethod
    def _connect(port: int) -> socket.socket:
        deadline = time.monotonic() + 240
        while True:
            try:
                return socket.create_connection(("127.0.0.1", port), timeout=240)
            except OSError:
                if time.monotonic() > deadline:
                    raise
                time.sleep(0.2)

    def _receive(self) -> Any:
        while b":" not in self._buffer:
            self._buffer += self._socket.recv(65536)
        length, _, rest = self._buffer.partition(b":")
        while len(rest) < int(length):
            rest += self._socket.recv(1 << 20)
        self._buffer = rest[int(length) :]
        return json.loads(rest[: int(length)])

    def call(self, command: str, **parameters: Any) -> Any:
        """A command, and what it gives."""
        self._number += 1
        message = json.dumps([0, self._number, command, parameters]).encode()
        self._socket.sendall(str(len(message)).encode() + b":" + message)
        _, _, error, result = self._receive()
        assert error is None, error
        return result

    def run(self, expression: str) -> Any:
        """The value of an expression in the page."""
        found = self.call("WebDriver:ExecuteScript", script=f"return {expression}", args=[])
        return found["value"]

    def wait(self, expression: str, seconds: float = 120.0) -> Any:
        """The expression's value as soon as it is true."""
        deadline = time.monotonic() + seconds
        while not (value := self.run(expression)):
            assert time.monotonic() < deadline, f"never came true: {expression}"
            time.sleep(0.1)
        return value

    def open(self, path: Path) -> None:
        """Open a page and wait until it is ready."""
        self.call("WebDriver:SetWindowRect", width=1280, height=800)
        self.call("WebDriver:Navigate", url=path.resolve().as_uri())
        self.wait("document.documentElement.dataset.ready")

    def picture(self, path: Path) -> Path:
        """A screenshot."""
        path.write_bytes(base64.b64decode(self.call("WebDriver:TakeScreenshot", full=False)["value"]))
        return path

    def close(self) -> None:
        """End the browser."""
        self._socket.close()
        self._process.terminate()
        try:
            self._process.wait(20)
        except subprocess.TimeoutExpired:
            self._process.kill()
        shutil.rmtree(self._profile, ignore_errors=True)
