"""The practice page: how long it takes to open in a real browser, drawn by the processor there; bytes by part.

A page of two minutes of the demo's hardest chart, in a fresh headless Chromium each time; the least of some openings,
from the start of navigation to the first frame. Nothing where no Chromium is; a row of a GPU where Chromium finds one:
there a frame takes a 60th of a second or longer, for the browser asks for no more. Times are of the clock: on a machine
that is busy they say little. And pages of 8 and 15 minutes of 16ths, 10 rows a second (`bench_growth.chart`): their
bytes, and the processor time of the first with and without the pieces of the dance that were kept.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
import time
from pathlib import Path
from unittest.mock import patch

from bench_growth import chart

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.page.work import Page, PageRequest, make_page

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests" / "page"))
from page_chromium import Browser

ROOT = Path(__file__).resolve().parent.parent
DEMO = ROOT / "charts" / "two_left_feet" / "two_left_feet.ssc"
OPENINGS = 5
FRAMES = """new Promise(done => {
  const times = [];
  const frame = now => times.push(now) < 61 ? requestAnimationFrame(frame) : done((times.at(-1) - times[0]) / 60);
  document.querySelector("button.play, .bar button")?.click();
  requestAnimationFrame(frame);
})"""
RENDERER = """(() => {
  const gl = document.createElement("canvas").getContext("webgl2");
  return gl ? gl.getParameter(gl.getExtension("WEBGL_debug_renderer_info").UNMASKED_RENDERER_WEBGL) : "";
})()"""
BY_GPU = ("--use-angle=vulkan", "--enable-features=Vulkan", "--ignore-gpu-blocklist")
BY_PROCESSOR = ("", "SwiftShader", "llvmpipe", "lavapipe")  # what software says of itself
Row = tuple[str, float, str, str, str]


def measure() -> list[Row]:
    """Rows for tools/bench.py."""
    page = make_page(PageRequest(DanceRequest(DEMO, Selection(difficulty="challenge"))))
    return [*sizes(page), *long_pages(), *opened(page)]


def sizes(page: Page) -> list[Row]:
    """Bytes by part."""
    out: list[Row] = [("page without music", len(page.html) / 1e6, "MB", "4 for two minutes", "")]
    return out + [(f"page, {part}", size / 1e3, "kB", "", "") for part, size in sorted(page.sizes.items())]


def opened(page: Page) -> list[Row]:
    """Times of the clock in a browser; none where there is no Chromium."""
    out: list[Row] = []
    if shutil.which("chromium") is None:
        return out
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "page.html"
        path.write_bytes(page.html)
        ready_after, frame = [], []
        for _ in range(OPENINGS):
            _, ready, drawn = _look(Browser(), path)
            ready_after.append(ready)
            frame.append(drawn)
        renderer, _, by_gpu = _look(Browser(flags=BY_GPU), path, (1920, 1080))
    out.append(("page, opening to the first frame", min(ready_after), "ms", "1000", ""))
    out.append(("page, a frame at 1280x720, drawn by the processor", min(frame), "ms", "", ""))
    if not any(word in renderer if word else not renderer for word in BY_PROCESSOR):
        out.append((f"page, a frame at 1920x1080, drawn by {renderer}", by_gpu, "ms", "16.7", ""))
    return out


def long_pages() -> list[Row]:
    """Bytes and processor time of long pages."""
    with tempfile.TemporaryDirectory() as folder:
        requests = {}
        for minutes in (8, 15):
            path = Path(folder) / f"{minutes}.sm"
            path.write_text(chart(minutes), encoding="utf-8")
            requests[minutes] = PageRequest(DanceRequest(path, Selection()))
        page = make_page(requests[8])  # kernels are there from now on, and the pieces are kept
        start = time.process_time()
        make_page(requests[8])
        kept = time.process_time() - start
        with patch("dancetutor_cli.dance.pieces.kept_folder", return_value=None):
            start = time.process_time()
            long = make_page(requests[15])
            whole = (time.process_time() - start) * 8 / 15
    return [
        ("page of 8 minutes", len(page.html) / 1e6, "MB", "", ""),
        ("page of 15 minutes", len(long.html) / 1e6, "MB", "4", ""),
        ("page of 8 minutes, processor time, its dance kept", kept, "s", "8", ""),
        ("page of 8 minutes, processor time, danced again (of 15)", whole, "s", "8", ""),
    ]


def _look(browser: Browser, path: Path, size: tuple[int, int] = (1280, 720)) -> tuple[str, float, float]:
    """What draws the page, when the first frame was there, and what a frame takes while it plays; milliseconds."""
    try:
        browser.size(*size)
        browser.open(path, live=True)
        ready = float(browser.run("document.documentElement.dataset.ready"))
        return str(browser.run(RENDERER)), ready, float(browser.run(FRAMES))
    finally:
        browser.close()
