"""The page of a capture: what it holds, and in a real browser that its distances and its controls are true."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import numpy as np
import pytest
from page_chromium import Browser, text
from PIL import Image
from test_page_document import unpacked

from dancetutor_cli.character.retargeting import Retargeting, RetargetTask
from dancetutor_cli.commands.retarget import command
from dancetutor_cli.dance.physics.pipeline import CORRECTIONS, RagdollOptions
from dancetutor_cli.formats.bvh import read_bvh, write_bvh
from dancetutor_cli.formats.captured import read_source

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "dance"))
from captured_people import renamed  # noqa: E402
from physics_phrase import phrase  # noqa: E402

SECOND = 0.5


@pytest.fixture(scope="module")
def work(tmp_path_factory: pytest.TempPathFactory) -> Retargeting:
    path = tmp_path_factory.mktemp("capture") / "walker.bvh"
    write_bvh(path, renamed(phrase(1.0), "lafan1"))
    return Retargeting(
        RetargetTask(path, "dancer", "neutral", RagdollOptions(corrections=CORRECTIONS, own_legs=True)),
        read_source(path),
    )


@pytest.fixture(scope="module")
def capture_file(work: Retargeting) -> Path:
    path = work.task.file.with_suffix(".html")
    command.main([str(work.task.file), "-o", str(path)], standalone_mode=False)
    return path


@pytest.fixture
def opened(browser: Browser, capture_file: Path) -> Browser:
    browser.size(1280, 720)
    browser.problems.clear()
    browser.open(capture_file)
    return browser


def at_second(work: Retargeting, second: float) -> dict[str, float]:
    """Centimetres of each point from the input, by the motions' own keys."""
    names, before, after = work.point_paths()
    key = int(np.argmin(np.abs(work.input_on_body.times - second)))
    assert abs(work.input_on_body.times[key] - second) < 1e-6
    return dict(zip(names, 100.0 * np.linalg.norm(after[key] - before[key], axis=1), strict=True))


def seek(browser: Browser, second: float) -> None:
    browser.run(
        f"(e => {{ e.value = {second}; e.dispatchEvent(new Event('input')); }})(document.querySelector('.strip'))"
    )
    browser.drawn()


def test_it_loads_nothing_and_holds_the_capture(work: Retargeting, capture_file: Path) -> None:
    page = capture_file.read_bytes()
    assert len(page) < 1_000_000
    head = page.decode("utf-8").partition("</head>")[0]
    assert "default-src 'none'" in head and not re.findall(r"https?://", page.decode("utf-8"))
    doc = unpacked(page)
    assert doc["words"]["title"] == "walker"
    assert len(doc["parents"]) == len(read_bvh(work.task.file, ends=True).skeleton.names)
    assert doc["points"] == list(work.point_paths()[0])


def test_the_input_figure_is_the_files_own_skeleton(work: Retargeting) -> None:
    """Each bone as long as in the file, in one proportion; hips and looks where the input has them on the body."""
    parents, places = work.input_figure
    own = read_bvh(work.task.file, ends=True).skeleton
    joints = np.arange(1, len(parents))
    drawn = np.linalg.norm(places[:, joints] - places[:, parents[joints]], axis=2)
    given = np.linalg.norm(own.offsets[joints], axis=1)
    assert np.ptp(drawn / given) < 1e-5
    assert places[:, :, 1].min() > -0.06 and places[:, :, 1].max() > 1.4
    toes = [k for k, name in enumerate(own.names) if name.endswith("Toe")]
    ankles = [k for k, name in enumerate(own.names) if name.endswith("Foot")]
    assert (places[:, toes] - places[:, ankles])[..., 2].mean() > 0.05, "looks to +Z"


def test_distances_are_those_of_the_motions(opened: Browser, work: Retargeting) -> None:
    seek(opened, SECOND)
    rows = opened.run("[...document.querySelectorAll('tbody tr')].map(r => [...r.children].map(c => c.textContent))")
    truth = at_second(work, SECOND)
    assert [row[0] for row in rows] == list(truth)
    assert max(abs(float(row[1]) - truth[row[0]]) for row in rows) < 0.25  # millimetres, and a rounded number
    _, before, after = work.point_paths()
    far = 100.0 * np.linalg.norm(after - before, axis=2)
    assert max(abs(float(row[2]) - one) for row, one in zip(rows, far.mean(axis=0), strict=True)) < 0.25
    assert max(abs(float(row[3]) - one) for row, one in zip(rows, far.max(axis=0), strict=True)) < 0.25
    said = text(opened, ".output").split()
    assert said[0] == "output:" and abs(truth[said[1]] - max(truth.values())) < 0.25  # of two as far, either
    assert abs(float(said[2]) - max(truth.values())) < 0.25
    opened.run("document.querySelector('tbody tr:nth-child(10) button').click()")
    opened.drawn()
    row = opened.run("[...document.querySelector('tbody tr:nth-child(10)').children].map(c => c.textContent)")
    assert row[1] == row[3], "the button goes to the moment of the largest"


def test_it_plays_slowly_steps_and_turns_by_keys(opened: Browser, tmp_path: Path) -> None:
    def shown() -> float:
        return float(text(opened, ".clock").split()[0])

    opened.run("(e => { e.value = '0.25'; e.dispatchEvent(new Event('change')); })(document.querySelector('.rate'))")
    opened.key(" ", "Space")
    opened.turn(0.06)  # what passes before the clock begins
    opened.turn(0.8)
    assert abs(shown() - 0.2) < 0.011
    opened.key(" ", "Space")
    before = shown()
    opened.turn(1.0)
    assert shown() == before
    opened.key(".")
    assert abs(shown() - before - 1 / 30) < 0.011
    seek(opened, SECOND)
    first = np.asarray(Image.open(opened.picture(tmp_path / "a.png")).convert("RGB")).astype(int)
    opened.run("document.querySelector('.picture').focus()")
    opened.key("ArrowRight")
    second = np.asarray(Image.open(opened.picture(tmp_path / "b.png")).convert("RGB")).astype(int)
    left, top, width, height = opened.box(".picture")
    half = np.s_[int(top) : int(top + height), int(left) : int(left + width / 2)]
    amber = (np.abs(first[half] - [242, 181, 90]).max(axis=2) < 12).sum()
    assert amber > 500, "the skeleton is drawn in the input's half"
    assert (np.abs(first - second).max(axis=2) > 40).mean() > 0.01, "both turned"
    opened.click("footer .bar:last-of-type button:last-child")  # whoever has clicked a button still turns by keys
    before_turn = opened.run("document.querySelector('.lines').toDataURL()")
    opened.key("ArrowRight")
    assert opened.run("document.querySelector('.lines').toDataURL()") != before_turn
    at = shown()
    opened.run("document.querySelector('.strip').focus()")
    before_turn = opened.run("document.querySelector('.lines').toDataURL()")
    opened.call("Input.dispatchKeyEvent", type="keyDown", key="ArrowUp", code="ArrowUp", windowsVirtualKeyCode=38)
    opened.drawn()
    assert shown() > at, "on the strip they go through the time"
    opened.run("document.activeElement.blur()")
    dots = opened.run("document.querySelector('.lines').toDataURL()")
    opened.key("d")
    assert opened.run("document.querySelector('.lines').toDataURL()") != dots
    assert opened.problems == [] and [url for url in opened.requests if not url.startswith(("file:", "blob:"))] == []


@pytest.mark.parametrize(("width", "height"), [(1280, 720), (768, 1024), (380, 740)])
def test_it_fits_every_screen(browser: Browser, capture_file: Path, width: int, height: int) -> None:
    browser.size(width, height, touch=width < 1000)
    browser.open(capture_file)
    assert browser.run("document.documentElement.scrollWidth") <= width
    boxes = browser.run(
        "['.picture', '.play', '.strip', '.rate'].map(s => (b => [b.left, b.top, b.right, b.bottom])"
        "(document.querySelector(s).getBoundingClientRect()))"
    )
    assert all(left >= 0 and right <= width and bottom <= height for left, _, right, bottom in boxes)
    assert boxes[0][3] - boxes[0][1] > 0.55 * height
    if width < 1000:
        small = (
            "[...document.querySelectorAll('footer button')].filter(b => b.getBoundingClientRect().height < 44).length"
        )
        assert browser.run(small) == 0
    browser.size(1280, 720)
    assert browser.problems == []


def test_axe_finds_nothing_serious(opened: Browser) -> None:
    source = Path(__file__).parent / "node_modules" / "axe-core" / "axe.min.js"
    if not source.exists():
        pytest.skip("no axe here; `make page-tools` puts it into tests/page/node_modules")
    opened.run(source.read_text("utf-8") + "; 1")
    found = opened.run(
        "axe.run(document, {resultTypes: ['violations']}).then(r => r.violations"
        ".filter(v => ['serious', 'critical'].includes(v.impact)).map(v => v.id + ' ' + v.nodes[0].html))"
    )
    assert found == []


def test_without_webgl_both_figures_are_lines(capture_file: Path) -> None:
    browser = Browser(flags=("--disable-gpu", "--disable-3d-apis"))
    try:
        browser.size(1280, 720)
        browser.open(capture_file)
        colours = browser.run(
            "[...(c => c.getContext('2d').getImageData(0, 0, c.width, c.height).data)"
            "(document.querySelector('.lines'))]"
            ".reduce((s, v, i, d) => { if (i % 4 === 0 && v === 143 && d[i + 1] === 180) s += 1; return s; }, 0)"
        )
        assert colours > 500
    finally:
        browser.close()
