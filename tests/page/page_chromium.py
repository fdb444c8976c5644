"""A headless Chromium for tests, driven over a pipe by its DevTools protocol: nothing but the browser is needed."""

from __future__ import annotations

import base64
import json
import os
import select
import shutil
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Any

import pytest

FLAGS = (
    "--headless", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--use-gl=angle", "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader", "--autoplay-policy=no-user-gesture-required", "--lang=en", "--hide-scrollbars",
    "--remote-debugging-pipe", "--proxy-server=127.0.0.1:9",
)  # fmt: skip

# A clock that only the test turns, in place of the page's and the audio output's: what is seen does not depend on how
# quickly the machine draws or the test asks.
STILL = """
window.turned = 0;
performance.now = () => window.turned;
Object.defineProperty(Event.prototype, 'timeStamp', {get: () => window.turned});
delete window.AudioContext;
"""

NOW = "Number(document.querySelector('.strip').getAttribute('aria-valuenow'))"  # the second of the music that is shown


def find() -> str:
    """The browser's command; skips the test with the reason where there is none."""
    if os.name == "nt":
        pytest.skip("the tests drive Chromium over inherited pipes, which Windows has not")
    for name in ("chromium", "chromium-browser", "google-chrome", "chrome"):
        if path := shutil.which(name):
            return path
    pytest.skip("no Chromium here; Debian/Ubuntu: apt-get install chromium")


class Browser:
    """One page in one browser. `problems` collects what the console and the page complain of, and every request."""

    def __init__(self, *, flags: tuple[str, ...] = ()) -> None:
        self.profile = tempfile.mkdtemp(prefix="page-test-")
        to_browser, self._out = os.pipe()
        self._in, from_browser = os.pipe()

        def pipes() -> None:  # the browser wants them at 3 and 4
            a, b = os.dup(to_browser), os.dup(from_browser)
            os.dup2(a, 3)
            os.dup2(b, 4)

        command = [find(), *FLAGS, *flags, f"--user-data-dir={self.profile}", "about:blank"]
        self._process = subprocess.Popen(
            command, preexec_fn=pipes, close_fds=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        os.close(to_browser)
        os.close(from_browser)
        self._buffer = b""
        self._number = 0
        self._openings = 0
        self._before = ""  # what runs in a page before its own script
        self.problems: list[str] = []
        self.requests: list[str] = []
        target = next(t for t in self._call("Target.getTargets")["targetInfos"] if t["type"] == "page")
        attached = self._call("Target.attachToTarget", {"targetId": target["targetId"], "flatten": True})
        self._session = attached["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """A command to the page, and its answer."""
        return self._call(method, parameters, self._session)

    def _call(
        self, method: str, parameters: dict[str, Any] | None = None, session: str | None = None
    ) -> dict[str, Any]:
        self._number += 1
        number = self._number
        message: dict[str, Any] = {"id": number, "method": method, "params": parameters or {}}
        if session:
            message["sessionId"] = session
        os.write(self._out, json.dumps(message).encode() + b"\0")
        deadline = time.monotonic() + 240
        while True:
            answer = self._read(deadline)
            if answer.get("id") == number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                result: dict[str, Any] = answer["result"]
                return result
            self._event(answer)

    def _read(self, deadline: float) -> dict[str, Any]:
        while b"\0" not in self._buffer:
            ready, _, _ = select.select([self._in], [], [], max(0.0, deadline - time.monotonic()))
            data = os.read(self._in, 1 << 20) if ready else b""
            if not data:
                raise RuntimeError("Chromium does not answer")
            self._buffer += data
        one, _, self._buffer = self._buffer.partition(b"\0")
        message: dict[str, Any] = json.loads(one)
        return message

    def _event(self, event: dict[str, Any]) -> None:
        method, p = event.get("method"), event.get("params", {})
        if method == "Runtime.exceptionThrown":
            detail = p["exceptionDetails"]
            self.problems.append(detail.get("exception", {}).get("description", detail["text"]))
        elif method == "Runtime.consoleAPICalled" and p["type"] in ("error", "warning", "assert"):
            self.problems.append(" ".join(str(a.get("value", a.get("description"))) for a in p["args"]))
        elif method == "Log.entryAdded" and p["entry"]["level"] in ("error", "warning"):
            # How slow reading a WebGL canvas back is for a screenshot is no complaint about the page.
            if "GPU stall due to ReadPixels" not in p["entry"]["text"]:
                self.problems.append(p["entry"]["text"])
        elif method == "Network.requestWillBeSent":
            self.requests.append(p["request"]["url"])

    def run(self, expression: str) -> Any:
        """The value of an expression in the page; a promise is waited for."""
        found = self.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in found:
            raise AssertionError(found["exceptionDetails"].get("exception", found["exceptionDetails"]))
        return found["result"].get("value")

    def wait(self, expression: str, seconds: float = 120.0) -> Any:
        """The expression's value as soon as it is true; a page that is left meanwhile is asked again."""
        deadline = time.monotonic() + seconds
        while not (value := self._value_or_left(expression)):
            assert time.monotonic() < deadline, f"never came true: {expression}; {self.problems}"
            time.sleep(0.05)
        return value

    def _value_or_left(self, expression: str) -> Any:
        """The value of an expression, or None if the page was left before it had one."""
        try:
            return self.run(expression)
        except RuntimeError as error:
            if "Inspected target navigated" not in str(error):
                raise
            return None

    def size(self, width: int, height: int, *, touch: bool = False) -> None:
        """The window's size in pixels of CSS."""
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=touch)
        self.call("Emulation.setTouchEmulationEnabled", enabled=touch)

    def open(self, path: Path, hash_: str = "", *, live: bool = False) -> None:
        """Open a page from the disk and wait until it is ready. Its clock stands until `turn`, unless it is `live`."""
        self._openings += 1
        if self._before:
            self.call("Page.removeScriptToEvaluateOnNewDocument", identifier=self._before)
        source = f"window.opening = {self._openings};" + ("" if live else STILL)
        self._before = self.call("Page.addScriptToEvaluateOnNewDocument", source=source)["identifier"]
        self.call("Page.navigate", url="about:blank")
        self.requests.clear()
        self.call("Page.navigate", url=path.resolve().as_uri() + hash_)
        self.wait(
            f"location.protocol === 'file:' && window.opening === {self._openings}"
            " && document.documentElement?.dataset.ready"
        )

    def turn(self, seconds: float) -> None:
        """The clock goes on, and the page has drawn what it shows then."""
        self.run(f"window.turned += {1000 * seconds}")
        self.drawn()

    def key(self, key: str, code: str = "", modifiers: int = 0) -> None:
        """Press and let go a key."""
        text = key if len(key) == 1 else ""
        number = {"Escape": 27}.get(key, 0)  # what the browser itself answers to it knows by number
        for kind in ("keyDown", "keyUp"):
            self.call(
                "Input.dispatchKeyEvent", type=kind, key=key, code=code or key, modifiers=modifiers,
                windowsVirtualKeyCode=number,
                **({"text": text} if text and kind == "keyDown" else {}),
            )  # fmt: skip
        self.drawn()

    def drawn(self) -> None:
        """Wait until the page has drawn what it was told: what it says of itself is of its last picture."""
        self.run("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))")

    def mouse(self, kind: str, x: float, y: float) -> None:
        """Mouse event: "mousePressed", "mouseMoved", "mouseReleased"."""
        button = "none" if kind == "mouseMoved" else "left"
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button=button, buttons=1, clickCount=1)

    def click(self, selector: str) -> None:
        """Click the middle of an element."""
        x, y, width, height = self.box(selector)
        for kind in ("mousePressed", "mouseReleased"):
            self.mouse(kind, x + width / 2, y + height / 2)
        self.drawn()

    def box(self, selector: str) -> tuple[float, float, float, float]:
        """Left, top, width and height of an element, scrolled into view."""
        found = self.run(
            f"(e => {{ e.scrollIntoView({{block: 'nearest'}}); const b = e.getBoundingClientRect();"
            f" return [b.x, b.y, b.width, b.height]; }})(document.querySelector({json.dumps(selector)}))"
        )
        return found[0], found[1], found[2], found[3]

    def picture(self, path: Path) -> Path:
        """A screenshot."""
        path.write_bytes(base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"]))
        return path

    def close(self) -> None:
        """End the browser."""
        self._process.terminate()
        self._process.wait(20)
        os.close(self._out)
        os.close(self._in)
        shutil.rmtree(self.profile, ignore_errors=True)


def text(browser: Browser, selector: str) -> str:
    """What an element says."""
    return str(browser.run(f"document.querySelector('{selector}').textContent"))


def pad_script() -> str:
    """A gamepad as the page sees it: an object whose buttons the test presses."""
    return (
        "window.pad = {id: 'test mat', index: 0, connected: true, mapping: '', axes: [], timestamp: 0,"
        " buttons: Array.from({length: 10}, () => ({pressed: false, value: 0}))};"
        "navigator.getGamepads = () => [window.pad];"
    )


def message(browser: Browser) -> str:
    """The message over the picture."""
    return text(browser, ".message")
