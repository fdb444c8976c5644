"""The practice page: how long it takes to open in a real browser, drawn by the processor there; bytes by part.

A page of two minutes of the demo's hardest chart, in a fresh headless Chromium each time; the least of some openings,
from the start of navigation to the first frame. Nothing where no Chromium is. Times are of the clock: on a machine that
is busy they say little.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from pathlib import Path

from dancetutor_cli.jobs.bake import BakeTask
from dancetutor_cli.jobs.page import PageTask, make_page
from dancetutor_cli.library.selection import Selection

ROOT = Path(__file__).resolve().parent.parent
DEMO = ROOT / "charts" / "two_left_feet" / "two_left_feet.ssc"
OPENINGS = 5
FRAMES = """new Promise(done => {
  const times = [];
  const frame = now => times.push(now) < 61 ? requestAnimationFrame(frame) : done((times.at(-1) - times[0]) / 60);
  document.querySelector("button.play, .bar button")?.click();
  requestAnimationFrame(frame);
})"""
Row = tuple[str, float, str, str, str]


def measure() -> list[Row]:
    """Rows for tools/bench.py."""
    page = make_page(PageTask(BakeTask(DEMO, Selection(difficulty="challenge"))))
    out: list[Row] = [("page without music", len(page.html) / 1e6, "MB", "4 for two minutes", "")]
    out += [(f"page, {part}", size / 1e3, "kB", "", "") for part, size in sorted(page.sizes.items())]
    if shutil.which("chromium") is None:
        return out
    sys.path.insert(0, str(ROOT / "tests" / "page"))
    from page_chromium import Browser

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "page.html"
        path.write_bytes(page.html)
        opened, frame = [], []
        for _ in range(OPENINGS):
            browser = Browser()
            try:
                browser.size(1280, 720)
                browser.open(path, live=True)
                opened.append(float(browser.run("document.documentElement.dataset.ready")))
                frame.append(float(browser.run(FRAMES)))
            finally:
                browser.close()
    out.append(("page, opening to the first frame", min(opened), "ms", "1000", ""))
    out.append(("page, a frame at 1280x720, drawn by the processor", min(frame), "ms", "", ""))
    return out
