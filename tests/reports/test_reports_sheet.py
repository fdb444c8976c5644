"""The chart sheet: what stands where, that it is self-contained, and that a real browser draws it."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image

from dancetutor_cli.chart.reader import parse
from dancetutor_cli.feet.limbs import hex_colour, limb_colours
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.solve import solve_chart
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.subject import ChartSubject
from dancetutor_cli.reports.sheet import make_sheet, sheets_html, svg_sheet
from dancetutor_cli.reports.sheet_places import lay_out, sheet_style

SVG = "{http://www.w3.org/2000/svg}"
ROWS = ["1000", "0100", "0001", "0010", "2000", "00M0", "3000", "0F00"]
SPIN = Finding("DT202", "spin", "warning", "a <spin> & more", 9, 3, 2, 1.5, 0, 0.75)


def subject(rows: list[str] = ROWS, title: str = "T<b>&\x1b[2J") -> ChartSubject:
    notes = "\n".join(rows)
    text = f"#TITLE:{title};\n#ARTIST:A;\n#BPMS:0=120;\n#NOTES:dance-single::Hard:9::\n{notes}\n;\n"
    song = parse(text.encode(), Path("x.sm"))
    chart = song.charts[0]
    return ChartSubject(song, chart, solve_chart(chart, load_preset("thesis")), load_pad("dance-single"))


def elements(svg: str, name: str) -> list[ElementTree.Element]:
    return list(ElementTree.fromstring(svg).iter(SVG + name))


def test_every_step_has_an_arrow_and_the_letter_of_its_limb() -> None:
    drawn = svg_sheet(make_sheet(subject(), [SPIN]), [])
    marks = [e.text for e in elements(drawn, "text") if e.get("class") == "mark"]
    assert marks == ["L", "R", "L", "R", "L", "R", "L"]  # two of them in the legend
    arrows = [e for e in elements(drawn, "use") if e.get("class") != "sample"]
    assert len(arrows) == 6  # five steps, one fake
    assert len([e for e in elements(drawn, "circle") if e.get("fill") == sheet_style().colours["mine"]]) == 1


def test_notes_have_the_colours_of_their_quantisation() -> None:
    style = sheet_style()
    assert [style.note_colour(tick) for tick in (0, 48, 24, 16, 12, 8, 6, 4, 3, 1)] == [
        style.quantisation[grid] for grid in (4, 4, 8, 12, 16, 24, 32, 48, 64, 192)
    ]


def test_feet_have_colours_of_their_own() -> None:
    style = sheet_style()
    assert set(style.limbs) == {hex_colour(rgb) for rgb in limb_colours().by_limb}
    assert not set(style.limbs) & set(style.quantisation.values())


def test_crossed_poses_are_drawn_and_findings_stand_in_their_row() -> None:
    sheet = make_sheet(subject(), [SPIN])
    drawn = svg_sheet(sheet, [])
    assert len([e for e in elements(drawn, "ellipse") if e.get("class") == "sole"]) >= 2
    code = next(e for e in elements(drawn, "text") if e.text == "DT202")
    assert abs(float(code.get("y", "")) - sheet.layout.y(72)) < 4


def test_rows_whose_feet_are_unsure_say_how_sure_they_are() -> None:
    usual, style = subject(), sheet_style()
    assert usual.play is not None and usual.play.confidence is None
    assert not [e for e in elements(svg_sheet(make_sheet(usual, []), []), "text") if e.get("class") == "sure"]
    sure = np.array([0.99, 0.4149, style.unsure / 100, 1, 0.6951, np.nan, 0.99, 0.99][: len(usual.play.rows)])
    sheet = make_sheet(replace(usual, play=replace(usual.play, confidence=sure)), [])
    drawn = svg_sheet(sheet, [])
    told = [e for e in elements(drawn, "text") if e.get("class") == "sure"]
    assert [e.text for e in told] == ["62", "41", "70"]  # the first is in the legend
    ticks = usual.play.rows.tick[[1, 4]].tolist()
    assert all(abs(float(e.get("y", "")) - sheet.layout.y(t)) < 12 for e, t in zip(told[1:], ticks, strict=True))
    bands = [e for e in elements(drawn, "rect") if e.get("fill-opacity") == "0.2"]
    assert [float(e.get("y", "")) + 7 for e in bands] == [pytest.approx(sheet.layout.y(t), abs=0.1) for t in ticks]
    assert "41 % sure of the foot here" in drawn


def test_text_of_the_file_cannot_break_out() -> None:
    page = sheets_html([(make_sheet(subject(title="</svg><script>x</script>"), [SPIN]), ["fact"])])
    assert "<script" not in page and "\x1b" not in page
    assert "a &lt;spin&gt; &amp; more" in page


def test_the_page_needs_nothing_from_outside() -> None:
    page = sheets_html([(make_sheet(subject(), [SPIN]), ["fact"])])
    assert re.findall(r"""(?:src|href)=["'](?!#)""", page) == []
    assert "url(" not in page and "@import" not in page
    assert set(re.findall(r"https?://[^\"' <]+", page)) <= {"http://www.w3.org/2000/svg"}


def test_measures_fill_columns_and_systems_in_order() -> None:
    layout = lay_out(np.arange(0, 192 * 60, 12), 4, sheet_style())
    assert layout.measures == 60
    drawn = [measure for which in range(layout.systems) for measure in layout.measures_of(which)]
    assert drawn == list(range(60))
    first, later = layout.heights[0], layout.heights[1]
    assert first < later  # the heading stands above the first system
    assert layout.left(0) < layout.left(first)
    assert layout.top(0) == layout.top(first) < layout.top(1)
    assert layout.left(first * layout.columns) == layout.left(0)  # the second system begins at the left again
    assert layout.columns * layout.column_width <= sheet_style().page_width
    for which in range(layout.systems):
        columns = {layout.column_of(measure) for measure in layout.measures_of(which)}
        assert len(columns) <= layout.columns and all(len(c) <= layout.heights[which] for c in columns)


@pytest.mark.parametrize("spacing", [12, 24, 48])
@pytest.mark.parametrize("lanes", [4, 5, 8, 10])
def test_every_system_fits_its_page(lanes: int, spacing: int) -> None:
    style = sheet_style()
    for measures in (1, 2, 7, 21, 60, 200):
        layout = lay_out(np.arange(0, 192 * measures, spacing), lanes, style)
        assert layout.system_height(0) + style.heading <= style.page_height + 1
        assert all(layout.system_height(n) <= style.page_height + 1 for n in range(layout.systems))
        assert layout.measures == measures


def test_the_heading_is_no_higher_than_the_layout_thinks() -> None:
    head = sheets_html([(make_sheet(subject(), [SPIN]), ["fact", "fact"])]).partition("<figure>")[2]
    height = float(re.search(r'viewBox="0 0 \S+ (\S+)"', head)[1])  # type: ignore[index]
    assert height <= sheet_style().heading + 2 * 18  # 18: what a system keeps above and below


def test_dense_charts_get_more_room() -> None:
    style = sheet_style()
    calm, dense = lay_out(np.arange(0, 960, 48), 4, style), lay_out(np.arange(0, 960, 12), 4, style)
    assert 0.9 * style.beat[0] <= calm.beat < dense.beat <= style.beat[1]
    assert dense.beat / 4 >= 0.9 * style.row_spacing


def test_a_chart_without_steps_in_its_first_measures_and_holds_over_columns() -> None:
    rows = "\n".join(["0000\n0000\n0000\n0000\n,"] * 30 + ["2000\n0000\n0000\n0000\n,"] * 1)
    rows += "\n" + "\n".join(["0000\n0000\n0000\n0000\n,"] * 20) + "\n0000\n3000\n0000\n0000"
    sheet = make_sheet(subject(rows.splitlines()), [])
    drawn = svg_sheet(sheet, [])
    bodies = [e for e in elements(drawn, "rect") if e.get("fill") == sheet.style.colours["hold"]]
    bodies = [e for e in bodies if e.get("class") != "key"]
    assert len(bodies) >= 2  # cut where a column ends
    total = sum(float(e.get("height", "0")) for e in bodies)
    assert total == pytest.approx(sheet.layout.beat * (21 * 4 + 1), abs=1.0)


@pytest.fixture
def browser(tmp_path: Path) -> Callable[..., str]:
    """Runs a headless Chromium with options and gives what it prints, or a skip."""
    program = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    if program is None:
        pytest.skip("no chromium here; apt-get install chromium")
    common = ["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", f"--user-data-dir={tmp_path}/profile"]

    def run(*options: str) -> str:
        done = subprocess.run([program, *common, *options], capture_output=True, timeout=120, check=False)
        return done.stdout.decode("utf-8", "replace")

    return run


def test_a_real_browser_draws_it(browser: Callable[..., str], tmp_path: Path) -> None:
    page, picture = tmp_path / "s.html", tmp_path / "s.png"
    page.write_text(sheets_html([(make_sheet(subject(), [SPIN]), ["fact"])]), encoding="utf-8")
    browser("--window-size=1000,700", f"--screenshot={picture}", page.as_uri())
    pixels = np.asarray(Image.open(picture).convert("RGB"), dtype=int)
    for colour in (*limb_colours().by_limb[:2], (0xEE, 0x3B, 0x4F), (0x3F, 0x74, 0xF5)):
        near = np.abs(pixels - np.array(colour)).max(axis=2) <= 6
        assert near.sum() >= 20, f"no {hex_colour(colour)} on the sheet"


def test_its_policy_forbids_scripts_and_every_place(browser: Callable[..., str], tmp_path: Path) -> None:
    """What somebody smuggles into a sheet neither runs nor loads; without the policy both would."""
    page, sheet = tmp_path / "s.html", sheets_html([(make_sheet(subject(), [SPIN]), ["fact"])])
    found = re.search(r'<meta http-equiv="Content-Security-Policy" content="([^"]*)">', sheet)
    assert found
    policy = dict(part.strip().split(" ", 1) for part in found[1].split(";"))
    assert policy == {"default-src": "'none'", "style-src": "'unsafe-inline'", "base-uri": "'none'",
                      "form-action": "'none'"}  # fmt: skip
    assert "<script" not in sheet and not re.findall(r"https?://(?!www\.w3\.org/)", sheet)
    other = tmp_path / "other.png"
    Image.new("RGB", (7, 5)).save(other)
    smuggled = (
        f'<img id="other" src="{other.as_uri()}" onload="document.title = \'loaded\'">'
        "<script>document.body.dataset.ran = 1</script>"
    )
    hostile = sheet.replace("</main>", f"{smuggled}</main>")
    page.write_text(hostile, encoding="utf-8")
    kept = browser("--dump-dom", page.as_uri())
    assert "</main>" in kept and "data-ran" not in kept and "<title>loaded" not in kept
    page.write_text(hostile.replace(found[0], ""), encoding="utf-8")
    assert 'data-ran="1"' in browser("--dump-dom", page.as_uri())


# Tells in the page itself how many texts and shapes reach over the edge of their picture.
MEASURE = """<script>
const lost = [];
for (const svg of document.querySelectorAll('svg')) {
  const box = svg.getBoundingClientRect();
  for (const e of svg.querySelectorAll('text, use, rect, circle, ellipse')) {
    if (e.closest('defs')) continue;
    const r = e.getBoundingClientRect();
    if (r.left < box.left - 1 || r.right > box.right + 1 || r.top < box.top - 1 || r.bottom > box.bottom + 1)
      lost.push(e.textContent || e.outerHTML);
  }
}
document.title = 'lost ' + lost.length + ': ' + lost.slice(0, 5).join(' | ');
</script>"""


@pytest.mark.parametrize("steps_type", ["dance-single", "dance-double", "pump-single", "pump-double"])
def test_nothing_is_cut_off_on_screen_or_on_paper(steps_type: str, browser: Callable[..., str], tmp_path: Path) -> None:
    lanes = {"dance-single": 4, "dance-double": 8, "pump-single": 5, "pump-double": 10}[steps_type]
    rows = ["".join("1" if lane in (n % lanes, n * 3 % lanes) else "0" for lane in range(lanes)) for n in range(16)]
    notes = "\n,\n".join(["\n".join(rows)] * 50)
    song = parse(f"#TITLE:T;\n#BPMS:0=120;\n#NOTES:{steps_type}::Hard:9::\n{notes}\n;\n".encode(), Path("x.sm"))
    play = solve_chart(song.charts[0], load_preset("itg"))
    findings = [replace(SPIN, beat=float(beat)) for beat in (0, 63.75, 199.75)]
    sheet = make_sheet(ChartSubject(song, song.charts[0], play, load_pad(steps_type)), findings)
    page, paper = tmp_path / "s.html", tmp_path / "s.pdf"
    page.write_text(
        sheets_html([(sheet, ["fact", "fact"])])
        .replace("</body>", f"{MEASURE}</body>")
        .replace("default-src 'none'", "default-src 'unsafe-inline'"),
        encoding="utf-8",
    )
    shown = browser("--window-size=1200,900", "--dump-dom", page.as_uri())
    assert "<title>lost 0: </title>" in shown, shown[:400]
    browser(f"--print-to-pdf={paper}", page.as_uri())
    pages = len(re.findall(rb"/Type\s*/Page\b", paper.read_bytes()))
    assert pages in (sheet.layout.systems, sheet.layout.systems + 1)  # a page a system; the findings may need one more


def test_one_row_is_a_row() -> None:
    sheet = make_sheet(subject(), [])
    assert sheet.say("rows", count=1) == "1 row" and sheet.say("rows", count=2) == "2 rows"
