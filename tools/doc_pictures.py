"""The pictures of films in README and docs, drawn anew: `python tools/doc_pictures.py [NAME...]`, all if none is named.

After a change that is seen in films, so that nobody is shown what the program no longer draws. docs/page-two.jpg is a
browser's: `tests/page/page_chromium.py` drives one, where there is one.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).resolve().parent.parent
DEMO = ROOT / "charts" / "two_left_feet" / "two_left_feet.ssc"
HARD = ("--steps-type", "dance-single", "--difficulty", "hard")
HEAD = "#TITLE:%s;\n#OFFSET:0;\n#BPMS:0=%d;\n#NOTES:%s::Hard:9::\n%s;\n"
ROUTINE = (
    "10000000\n01000000\n00010000\n00100000\n,\n10000000\n00100000\n00010000\n01000000\n&\n"
    "00001000\n00000001\n00001000\n00000010\n,\n00000100\n00000010\n00001000\n00000001\n"
)
CROSSWISE = "10000000\n00010000\n00001000\n00000001\n,\n00001000\n00010000\n10000000\n00010000\n"
FPS = 20


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
    chart, cell = written(folder, "dance-double", CROSSWISE, 140), (233, 236)
    sheet = Image.new("RGB", (3 * cell[0], 2 * cell[1]))
    for row, form in enumerate(("screen", "turning")):
        options = ("--layout", "background", "--size", "520x292", "--section", "0:1.4", "--form", form)
        found = frames(folder, chart, *options)
        for column, second in enumerate((0.5, 0.7, 0.9)):
            picture = Image.open(found[round(second * FPS)]).convert("RGB")
            left = (picture.width - cell[0]) // 2
            top = picture.height - cell[1]
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
}


def main() -> None:
    """Draw those that are named, or all."""
    for name in sys.argv[1:] or PICTURES:
        with tempfile.TemporaryDirectory() as folder:
            PICTURES[name](Path(folder))
        print(name)


if __name__ == "__main__":
    main()
