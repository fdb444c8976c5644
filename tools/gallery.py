"""Films, sheets and pages of free songs, and an index of them, for `make gallery`: `python tools/gallery.py [FOLDER]`.

The commands of the program make everything, from `charts/` and from notes in this file; with ../shared beside the
repository, a song and a capture of it are added. A piece that is still current is not made again: its key is a hash of
its command and of the program, so an interrupted run continues where it was.
"""

from __future__ import annotations

import html
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from dancetutor_cli.run.stored_files import fingerprint, program_hash

ROOT = Path(__file__).resolve().parent.parent
SHARED = ROOT.parent / "shared" / "data"
DEMO = str(ROOT / "charts" / "two_left_feet" / "two_left_feet.ssc")
GOIN_UNDER = SHARED / "songs" / "goin_under" / "Goin' Under.ssc"
DAB = SHARED / "bvh" / "fair_dab.bvh"
SMALL = ("--size", "640x360", "--yes")
TALL = ("--size", "360x640", "--yes")
HEAD = "#TITLE:%s;\n#ARTIST:dancetutor;\n#OFFSET:0;\n#BPMS:0=%d;\n#NOTES:%s::Hard:%d::\n%s;\n"
COUPLE = "10000001\n00100100\n01000010\n00011000\n,\n10010000\n01100000\n00001001\n00000110\n,\n" * 2 + "10001000\n"
PUMP = "10000\n00100\n00001\n00010\n,\n00100\n01000\n10000\n00100\n,\n10001\n00100\n01010\n00100\n,\n" * 2 + "00100\n"


@dataclass(frozen=True)
class Piece:
    """One thing to show. file : its name in the gallery; title : one line; steps : calls of the command, "OUT" for the
    file and "DIR" for the gallery's folder; needs : files without which it is left out"""

    file: str
    title: str
    steps: tuple[tuple[str, ...], ...]
    needs: tuple[Path, ...] = ()


def film(name: str, title: str, *options: str, chart: str = DEMO, size: tuple[str, ...] = SMALL) -> Piece:
    """A short film."""
    return Piece(f"{name}.mp4", title, (("render", chart, "-o", "OUT", "-q", *size, *options),))


def pieces() -> Iterator[Piece]:
    """What the gallery shows, in order."""
    yield film("crossovers", "Hard 8: crossovers called out before they come", "--index", "3", "--section", "b44:b60")
    yield film("beginner", "Beginner 1, from the front", "--index", "0", "--section", "b4:b16", "--camera", "front")
    yield film("challenge", "Challenge 11, upright for phones", "--index", "4", "--section", "b64:b80",
               "--layout", "vertical", size=TALL)  # fmt: skip
    yield film("practice", "Practice: half speed, then full speed", "--index", "3", "--section", "b44:b52",
               "--layout", "practice", "--rate", "0.5,1")  # fmt: skip
    yield film("double", "A double: eight panels", "--index", "5", "--section", "b44:b60")
    yield film("television", "The notes on a television in the room", "--index", "2", "--section", "b32:b44",
               "--layout", "television")  # fmt: skip
    yield film("fierce", "Style: fierce", "--index", "3", "--section", "b44:b60", "--style", "fierce")
    yield film("lazy", "The same passage, style: lazy", "--index", "3", "--section", "b44:b60", "--style", "lazy")
    yield film("couple", "A couple chart: two dancers, two pads", "--section", "b0:b14", chart="DIR/couple.sm")
    yield film("pump", "A Pump pad: five panels", "--section", "b0:b14", chart="DIR/pump.sm")
    yield Piece("capture.mp4", "Captured motion (BVH) put on the mannequin", (
        ("animate", DEMO, "--index", "3", "--section", "0:9", "--style", "heavy", "-o", "DIR/capture.bvh"),
        ("retarget", "DIR/capture.bvh", "--character", "mannequin", "-o", "DIR/capture.npz"),
        ("render", DEMO, "--index", "3", "--section", "2:9", "--dance", "DIR/capture.npz", "--character",
         "mannequin", "-o", "OUT", "-q", *SMALL),
    ))  # fmt: skip
    yield Piece("sheet.html", "A sheet: the chart on paper, with feet and findings",
                (("analyze", DEMO, "--index", "3", "--sheet", "OUT", "--exit-zero", "-q"),))  # fmt: skip
    yield Piece("sheet-de.html", "A sheet in German",
                (("analyze", DEMO, "--index", "4", "--sheet", "OUT", "--language", "de", "--exit-zero", "-q"),)
    )  # fmt: skip
    yield Piece(
        "page.html", "A practice page, with its music", (("page", DEMO, "--index", "3", "--music", "-o", "OUT", "-q"),)
    )
    yield Piece("page-ja.html", "A practice page that begins in Japanese",
                (("page", DEMO, "--index", "4", "--language", "ja", "-o", "OUT", "-q"),))  # fmt: skip
    yield Piece("pack.html", "A folder of songs on a page",
                (("analyze", str(ROOT / "charts"), "--report-html", "OUT", "--exit-zero", "-q"),))  # fmt: skip
    under = film("goin-under", "Goin' Under: a song of the game", "--section", "hardest:1", "--steps-type",
                 "dance-single", "--difficulty", "hard", chart=str(GOIN_UNDER))  # fmt: skip
    yield Piece(under.file, under.title, under.steps, (GOIN_UNDER,))
    yield Piece("dab.mp4", "A dance captured in a studio, put on the dancer", (
        ("retarget", str(DAB), "-o", "DIR/dab.npz"),
        ("render", DEMO, "--index", "3", "--section", "1:9", "--layout", "dancer", "--mute", "--dance", "DIR/dab.npz",
         "-o", "OUT", "-q", *SMALL),
    ), (DAB,))  # fmt: skip


def made(folder: Path, piece: Piece) -> bool:
    """Make a piece unless it is there and still true; False if it was."""
    out, key = folder / piece.file, folder / f".{piece.file}.key"
    wanted = fingerprint(piece.steps, program_hash())
    if out.exists() and key.exists() and key.read_text("utf-8") == wanted:
        return False
    for step in piece.steps:
        call = [one.replace("DIR", str(folder)).replace("OUT", str(out)) for one in step]
        subprocess.run([sys.executable, "-m", "dancetutor_cli", *call], check=True, cwd=ROOT, stdout=subprocess.DEVNULL)
    key.write_text(wanted, "utf-8")
    return True


def figure(piece: Piece, folder: str = "") -> str:
    """A piece in HTML. folder : where its file is, "" or "gallery/" """
    title, file = html.escape(piece.title), folder + piece.file
    if piece.file.endswith(".mp4"):
        shown = f'<video src="{file}" controls loop muted playsinline preload="metadata"></video>'
    else:
        shown = f'<p><a href="{file}">{html.escape(piece.file)}</a></p>'
    return f"<figure>{shown}<figcaption>{title}</figcaption></figure>"


GRID = """\
.gallery { display: grid; grid-template-columns: repeat(auto-fill, minmax(280px, 1fr)); gap: 1.2rem; }
.gallery figure { margin: 0; width: auto; }
.gallery video { width: 100%; height: 220px; object-fit: contain; background: #0c0e1a; }
"""
BODY = "body { margin: 2rem auto; max-width: 1200px; padding: 0 1rem; font: 16px/1.5 system-ui, sans-serif; }\n"


def write_index(folder: Path, shown: list[Piece]) -> None:
    """The gallery as a page of its own, and as one of the documents' site."""
    figures = "\n".join(figure(one) for one in shown)
    head = '<meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>Gallery</title>'
    page = f'<!DOCTYPE html>\n<html lang="en"><head>{head}<style>{BODY}{GRID}</style></head>\n<body><h1>Gallery</h1>\n'
    (folder / "index.html").write_text(f'{page}<main class="gallery">\n{figures}\n</main></body></html>\n', "utf-8")
    figures = "\n".join(figure(one, "gallery/") for one in shown)
    others = "; the last ones from a song and a capture of the test data" if any(one.needs for one in shown) else ""
    intro = f"All of this is made by `make gallery` from the demo song and from a few rows of notes{others}.\n"
    text = f'# Gallery\n\n{intro}\n<style>{GRID}</style>\n<div class="gallery">\n{figures}\n</div>\n'
    (folder / "gallery.md").write_text(text, "utf-8")


def main(folder: Path) -> None:
    """Make what is missing, and the index; one line for each piece."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "couple.sm").write_text(HEAD % ("Side by side", 120, "dance-couple", 5, COUPLE), "utf-8")
    (folder / "pump.sm").write_text(HEAD % ("Five panels", 110, "pump-single", 6, PUMP), "utf-8")
    every = [one for one in pieces() if all(path.exists() for path in one.needs)]
    for number, piece in enumerate(every, 1):
        said = "made" if made(folder, piece) else "still true"
        print(f"[{number}/{len(every)}] {piece.file}: {said}", flush=True)
    write_index(folder, every)
    print(f"{folder / 'index.html'}: {len(every)} pieces")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "build" / "gallery")
