"""Draw the pictures of films and terminals in README and docs again: `python tools/doc_pictures.py [NAME...]`, or all.

Run it after a change that is visible in films or in printed lines, so that nobody sees what is no longer so.
docs/page-two.jpg comes from a browser: `tests/page/page_chromium.py` drives one, if there is one. `make docs-pictures`
draws them all.
"""

from __future__ import annotations

import functools
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.performance import solve
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.feet.limbs import limb_colours
from dancetutor_cli.run.reading import config_names

ROOT = Path(__file__).resolve().parent.parent
DEMO = ROOT / "charts" / "two_left_feet" / "two_left_feet.ssc"
HARD = ("--steps-type", "dance-single", "--difficulty", "hard")
SCREENS = {  # picture -> command line, and how many lines of its output are shown
    "linter.svg": ("analyze two_left_feet/two_left_feet.ssc --index 3 --full", 26),
    "fix.svg": ("analyze two_left_feet/two_left_feet.ssc --index 3 --fix DT202 --diff", 40),
    "beside.svg": ("analyze two_left_feet/two_left_feet.ssc --tech-counts beginner.csv", 40),
    "first-steps.svg": ("", 40),
}
HEAD = "#TITLE:%s;\n#OFFSET:0;\n#BPMS:0=%d;\n#NOTES:%s::Hard:9::\n%s;\n"
ROUTINE = (
    "10000000\n01000000\n00010000\n00100000\n,\n10000000\n00100000\n00010000\n01000000\n&\n"
    "00001000\n00000001\n00001000\n00000010\n,\n00000100\n00000010\n00001000\n00000001\n"
)
CROSSWISE = "10000000\n00010000\n00001000\n00000001\n,\n00001000\n00010000\n10000000\n00010000\n"
FPS = 20
CROSSED = 5  # of the pictures of a short cut, five a second: the one in which the feet cross
CHALLENGE, ROWS = 4, 8  # which chart, and how many of its rows, the picture of presets shows
LANE, GROUP = 32, 170  # pixels of a lane, and from one preset to the next


def frames(folder: Path, chart: Path, *options: str) -> list[Path]:
    """The pictures of a film of `chart`, in order."""
    out = Path(tempfile.mkdtemp(dir=folder))
    command = [sys.executable, "-m", "dancetutor_cli", "render", str(chart), "--frames", str(out), "-q", "--mute"]
    subprocess.run([*command, "--fps", str(FPS), *options], check=True, cwd=ROOT)
    return sorted(out.glob("*.png"))


def written(folder: Path, kind: str, notes: str, bpm: int = 120) -> Path:
    """A chart file of these notes."""
    path = folder / f"{kind}.sm"
    path.write_text(HEAD % ("Two", bpm, kind, notes))
    return path


def readme(folder: Path) -> None:
    """A frame of the demo with a crossover called out."""
    found = frames(folder, DEMO, *HARD, "--section", "16:19")
    Image.open(found[round(1.6 * FPS)]).convert("RGB").save(ROOT / ".github" / "frame.png", optimize=True)


def two(folder: Path) -> None:
    """A routine: both on one pad."""
    found = frames(folder, written(folder, "dance-routine", ROUTINE), "--size", "960x540", "--section", "0:4")
    save(found[round(1.0 * FPS)], "two.jpg")


def background(folder: Path) -> None:
    """The dancer alone."""
    found = frames(folder, DEMO, *HARD, "--layout", "background", "--size", "480x270", "--section", "16:19")
    save(found[round(1.6 * FPS)], "background.jpg")


def crossing(folder: Path) -> None:
    """The same steps by two forms: the left foot over the right one, in front of it and behind it."""
    chart, cell = written(folder, "dance-double", CROSSWISE, 140), (233, 220)
    sheet = Image.new("RGB", (3 * cell[0], 2 * cell[1]))
    for row, form in enumerate(("screen", "turning")):
        options = ("--layout", "background", "--size", "520x292", "--section", "0:1.4", "--form", form)
        found = frames(folder, chart, *options)
        for column, second in enumerate((0.5, 0.7, 0.9)):
            picture = Image.open(found[round(second * FPS)]).convert("RGB")
            left = (picture.width - cell[0]) // 2
            top = picture.height - cell[1]  # below the call
            sheet.paste(picture.crop((left, top, left + cell[0], top + cell[1])), (column * cell[0], row * cell[1]))
    sheet.save(ROOT / "docs" / "crossing.jpg", quality=88, optimize=True)


def page_two(folder: Path) -> None:
    """The page of the same routine."""
    sys.path[:0] = [str(ROOT / "tests" / "page")]
    from page_chromium import Browser

    chart, page = written(folder, "dance-routine", ROUTINE), folder / "page.html"
    subprocess.run(
        [sys.executable, "-m", "dancetutor_cli", "page", str(chart), "-o", str(page), "-q"], check=True, cwd=ROOT
    )
    browser = Browser()
    browser.size(1280, 720)
    browser.open(page, "#m0")
    for _ in range(3):
        browser.key("ArrowRight")
    browser.run("new Promise(done => setTimeout(done, 1000))")
    browser.picture(folder / "page.png")
    browser.close()
    save(folder / "page.png", "page-two.jpg")


def styles(folder: Path) -> None:
    """The same moment in every style of the ragdoll, and without one."""
    names = ("", *config_names("styles"))
    found = [still(folder, *(("--style", name) if name else ())) for name in names]
    in_a_row(found, [name or "no style" for name in names], "styles.jpg")


def forms(folder: Path) -> None:
    """The same crossover in every form."""
    names = config_names("forms")
    in_a_row([still(folder, "--form", name) for name in names], names, "forms.jpg")


def still(folder: Path, *options: str) -> Image.Image:
    """The dancer of the demo's hard chart, in a crossover."""
    cut = ("--layout", "background", "--size", "480x270", "--section", "19:20.6", "--fps", "5")
    found = frames(folder, DEMO, *HARD, *cut, *options)
    picture = Image.open(found[CROSSED]).convert("RGB")
    return picture.crop((150, 20, 330, 270))


def in_a_row(pictures: list[Image.Image], names: list[str], target: str) -> None:
    """Pictures beside each other, each with its name below it."""
    width, height = pictures[0].size
    sheet = Image.new("RGB", (width * len(pictures), height + 22), (12, 14, 26))
    pen = ImageDraw.Draw(sheet)
    for place, (picture, name) in enumerate(zip(pictures, names, strict=True)):
        sheet.paste(picture, (place * width, 0))
        pen.text(((place + 0.5) * width, height + 11), name, (230, 232, 245), ImageFont.load_default(14), anchor="mm")
    sheet.save(ROOT / "docs" / target, quality=85, optimize=True)


def screen(name: str, folder: Path) -> None:
    """What a command prints, of a copy of the demo song."""
    shutil.copytree(DEMO.parent, folder / "two_left_feet")
    program, environment = (
        str(Path(sys.executable).with_name("dancetutor")),
        os.environ | {"DANCETUTOR_CACHE": str(folder)},
    )
    beginner = [program, "analyze", "two_left_feet/two_left_feet.ssc", "--preset", "beginner", "--format", "csv"]
    with (folder / "beginner.csv").open("w") as csv:
        subprocess.run([*beginner, "--exit-zero"], check=True, cwd=folder, env=environment, stdout=csv)
    words, lines = SCREENS[name]
    tool = [sys.executable, str(ROOT / "tools" / "terminal_picture.py"), str(ROOT / "docs" / name)]
    title = ["--title", f"dancetutor {words}".strip(), "--lines", str(lines)]
    subprocess.run([*tool, *title, "--", program, *words.split()], check=True, cwd=folder, env=environment)


def presets(folder: Path) -> None:
    """The same eight rows, with the feet that each preset gives them: where in the demo they differ most."""
    plays = {}
    for name in ("itg", "ddr", "stamina", "beginner"):
        (one,) = solve(DanceRequest(DEMO, Selection(index=CHALLENGE), name))
        assert one.play is not None
        plays[name] = one.play
    limbs = [play.limb for play in plays.values()]
    kinds = [len({limb[row : row + ROWS].tobytes() for limb in limbs}) for row in range(len(limbs[0]) - ROWS)]
    first = kinds.index(max(kinds))
    parts, width = [], len(plays) * GROUP
    for place, (name, play) in enumerate(plays.items()):
        left = place * GROUP
        parts.append(f'<text x="{left + 2 * LANE}" y="22" class="name">{name}</text>')
        for row, column in zip(*np.nonzero(play.rows.steps[first : first + ROWS] > 0), strict=True):
            limb = int(play.limb[first + row, column])
            x, y = left + (column + 0.5) * LANE, 48 + row * LANE
            colour = "#{:02x}{:02x}{:02x}".format(*limb_colours().by_limb[limb])
            parts.append(f'<circle cx="{x}" cy="{y}" r="13" fill="{colour}"/>')
            parts.append(f'<text x="{x}" y="{y + 5}" class="step">{"←↓↑→"[column]}{"LRlr"[limb]}</text>')
    height = 40 + ROWS * LANE
    style = "text{font-family:sans-serif;text-anchor:middle}.name{font-size:16px;fill:#888}.step{font-size:13px}"
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="-20 0 {width} {height}" width="{width}">'
    svg = f"{head}<style>{style}</style>{''.join(parts)}</svg>\n"
    (ROOT / "docs" / "presets.svg").write_text(svg, encoding="utf-8")


def save(picture: Path, name: str) -> None:
    """Into docs, small."""
    image = Image.open(picture).convert("RGB")
    image.thumbnail((960, 540), Image.Resampling.LANCZOS)
    image.save(ROOT / "docs" / name, quality=88, optimize=True)


PICTURES: dict[str, Callable[[Path], None]] = {
    "frame.png": readme,
    "two.jpg": two,
    "background.jpg": background,
    "crossing.jpg": crossing,
    "page-two.jpg": page_two,
    "presets.svg": presets,
    "styles.jpg": styles,
    "forms.jpg": forms,
    **{name: functools.partial(screen, name) for name in SCREENS},
}


def main() -> None:
    """Draw those that are named, or all."""
    for name in sys.argv[1:] or PICTURES:
        with tempfile.TemporaryDirectory() as folder:
            PICTURES[name](Path(folder))
        print(name)


if __name__ == "__main__":
    main()
