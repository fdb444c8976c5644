"""Feed broken input to every reader of files from other people: `make fuzz MINUTES=10`.

Charts, configurations, presets, layouts, baselines, plays, data.sme, characters and fonts are mutated from whole ones.
A reader may give a result or raise a `DancetutorError` of one line, within seconds; whatever else it does is a find,
which is written to tests/data/fuzz/ for the tests to try from then on.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import random
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

from PIL import ImageFont

from dancetutor_cli.run.errors import DancetutorError
from dancetutor_cli.run.reading import PACKAGE, charts_path, config_path

ROOT = Path(__file__).resolve().parent.parent
FINDS = ROOT / "tests" / "data" / "fuzz"
LONGEST = 20  # seconds for one input; kernels are compiled before the first
_WORDS = (
    b"#NOTES:", b"#NOTEDATA:;", b"#BPMS:0=1e999;", b"-", b"nan", b"1e308", b"999999999999999999999", b",", b";", b":",
    b"//", b"\\", b"\0", b"\xff\xfe", b"\xef\xbb\xbf", b"\n", b"\r", b"{dt1! LR}", b"2", b"3", b"4", b"M", b"K", b"{",
    b"[", b"&a", b"*a", b"<<", b"!!int", b".inf", b"- ", b"extends: ", b"null", b"true", b'"', b"[[[[[[[[", b"{}", b"=",
)  # fmt: skip
_JSON = ("baseline", "play", "editor")
Reader = Callable[[Path], object]


def _chart(path: Path) -> object:
    """Read, solve and lint; write feet and take them out again: the bytes must be the old ones."""
    from dancetutor_cli.chart.selection import Selection
    from dancetutor_cli.lint.analysis import analyze_file
    from dancetutor_cli.lint.run import LintRequest, LintRun
    from dancetutor_cli.markers.annotate import AnnotateRequest, Item, annotate_song

    before = path.read_bytes()
    result = analyze_file(LintRun(LintRequest()).task(path))
    if result.error:
        if "\n" in result.error:
            raise AssertionError("an error of several lines")
        return result
    for strip in (False, True):
        request = AnnotateRequest(("measure",), None, Selection(), strip=strip)
        (outcome,) = annotate_song([Item(path, path)], request)
        if outcome.error:
            break
    if path.read_bytes() != before and b"{dt1" not in before:
        raise AssertionError("what annotate wrote did not come out again")
    return result


def _configuration(path: Path) -> object:
    from dancetutor_cli.lint.run import LintRequest, LintRun

    run = LintRun(LintRequest())
    folder = path.with_suffix(".d")
    folder.mkdir(exist_ok=True)
    (folder / "dancetutor.yaml").write_bytes(path.read_bytes())
    song = folder / "x.sm"
    song.write_bytes(b"#TITLE:T;\n#BPMS:0=120;\n#NOTES:dance-single:C:Hard:9::\n1000\n0100\n0010\n0001\n;\n")
    from dancetutor_cli.lint.analysis import analyze_file

    return analyze_file(run.task(song))


def _preset(path: Path) -> object:
    from dancetutor_cli.feet.preset import load_preset

    return load_preset(path, confined=True)


def _layout(path: Path) -> object:
    from dancetutor_cli.film.layout import load_layout

    layout = load_layout(str(path))
    return [layout.box(name, layout.size, 4) for name in ("dancer", "highway") if getattr(layout, name)]


def _motion(path: Path) -> object:
    from dancetutor_cli.dance.settings import load_settings

    return load_settings(path)


def _baseline(path: Path) -> object:
    from dancetutor_cli.lint.baseline import load_baseline

    known = load_baseline(path)
    known.mark_seen("x.sm", "dance-single Hard", ["DT201"])
    return known.unused_keys()


def _play(path: Path) -> object:
    from dancetutor_cli.chart.reader import load
    from dancetutor_cli.feet.pads import load_pad
    from dancetutor_cli.feet.play import prepare_rows
    from dancetutor_cli.feet.play_json import read_play

    chart = load(charts_path() / "two_left_feet" / "two_left_feet.ssc").charts[0]
    pad = load_pad(chart.steps_type)
    assert pad is not None
    return read_play(path, chart, prepare_rows(chart, pad, 0.35))


def _editor(path: Path) -> object:
    """data.sme beside a song: read for its feet, and merged with ours."""
    from dancetutor_cli.chart.reader import load
    from dancetutor_cli.chart.selection import Selection
    from dancetutor_cli.feet.song_feet import SongFeet
    from dancetutor_cli.markers.annotate import AnnotateRequest, Item, annotate_song

    folder = path.with_suffix(".d")
    folder.mkdir(exist_ok=True)
    (folder / "data.sme").write_bytes(path.read_bytes())
    song = folder / "x.sm"
    song.write_bytes(b"#TITLE:T;\n#BPMS:0=120;\n#NOTES:dance-single:C:Hard:9::\n1000\n0100\n0010\n0001\n;\n")
    read = load(song)
    SongFeet(read).author_feet(read.charts[0])
    return annotate_song([Item(song, song)], AnnotateRequest(("smeditor",), None, Selection()))


def _character(path: Path) -> object:
    from dancetutor_cli.character.characters import load_character

    return load_character(str(path))


def _font(path: Path) -> object:
    from dancetutor_cli.film.overlay.text import Typeface

    face = Typeface(path)
    return face.sprite(face.fit("Ag é日 1", 20, 60), 20, (255, 255, 255))


# kind -> suffix, reader
KINDS: dict[str, tuple[str, Reader]] = {
    "sm": (".sm", _chart),
    "ssc": (".ssc", _chart),
    "configuration": (".yaml", _configuration),
    "preset": (".yaml", _preset),
    "layout": (".yaml", _layout),
    "motion": (".yaml", _motion),
    "baseline": (".json", _baseline),
    "play": (".json", _play),
    "editor": (".sme", _editor),
    "character": (".glb", _character),
    "font": (".ttf", _font),
}


def seeds(kind: str) -> list[bytes]:
    """Whole files of a kind, small ones first."""
    song = charts_path() / "two_left_feet" / "two_left_feet"
    hostile = ROOT / "tests" / "data" / "hostile"
    match kind:
        case "sm" | "ssc":
            files = sorted(hostile.glob(f"*.{kind}"))
            return [path.read_bytes() for path in files if path.stat().st_size < 20_000] + [
                path.read_bytes() for path in [song.with_suffix(f".{kind}")] if path.exists()
            ]
        case "configuration":
            return [path.read_bytes() for path in sorted(config_path("lint").glob("*.yaml"))] + [_SETTINGS]
        case "preset" | "layout":
            return [path.read_bytes() for path in sorted(config_path(f"{kind}s").glob("*.yaml"))]
        case "motion":
            return [config_path("motion.yaml").read_bytes()]
        case "baseline":
            return [_BASELINE]
        case "play":
            return [_a_play(song.with_suffix(".ssc"))]
        case "editor":
            return [_EDITOR]
        case "character":
            return [(PACKAGE / "character" / "data" / "mannequin.glb").read_bytes()]
        case _:
            built_in = ImageFont.load_default(24)
            assert isinstance(built_in, ImageFont.FreeTypeFont)
            return [built_in.font_bytes]


_SETTINGS = b"""extends: stamina
fail-on: error
baseline: known.json
select: [DT2, spin]
rules: {DT205: {max_rows: 4}, spin: error, DT401: {grid: [4, 8, 12]}, DT504: {sizes: [256x80]}}
overrides:
  - when: {path: "x*", steps-type: dance-single, difficulty: [Hard], meter: 8-}
    rules: {hand: off}
feet:
  - when: {difficulty: Hard}
    steps: {0: L, 1: R, 2.0: LR}
    ignore: {3: doublestep, 2: [DT202]}
"""
_BASELINE = (
    b'{"schema": 1, "entries": [{"file": "x.sm", "chart": "dance-single Hard", "rule": "DT201", "beat": 4.5, '
    b'"count": 2}, {"file": "y.ssc", "chart": "", "rule": "DT501", "line": 3}]}'
)
_EDITOR = (
    b'{"version": 3, "parity": {"dance-single": [{"overrides": [[0, 0, 1], [1, 1, 2]], "ignores": {"DS": [1.0]}}]}}'
)


def _a_play(path: Path) -> bytes:
    from click.testing import CliRunner

    from dancetutor_cli.commands import cli

    return CliRunner().invoke(cli, ["analyze", str(path), "--index", "0", "--format", "json"]).stdout_bytes


def swapped(data: bytes, chance: random.Random) -> bytes:
    """JSON with one value exchanged for one of another kind; other data as it is."""
    try:
        whole = [json.loads(data)]
    except ValueError:
        return data
    at: Any = whole
    while True:
        key = chance.choice(list(at) if isinstance(at, dict) else range(len(at)))
        if not isinstance(at[key], dict | list) or not at[key] or chance.random() < 0.15:
            at[key] = chance.choice((None, 1, -1, 1.5, 1e300, "x", [], {}, True, [[]], {"a": [1]}, [None], 10**30))
            return json.dumps(whole[0]).encode()
        at = at[key]


def mutated(data: bytes, chance: random.Random) -> bytes:
    """Some of the data changed, cut out, put in, doubled or exchanged."""
    out = bytearray(data)
    for _ in range(1 + int(chance.expovariate(0.5))):
        at, to = sorted((chance.randrange(len(out) + 1), chance.randrange(len(out) + 1)))
        to = min(to, at + chance.choice((1, 4, 40, 4000)))
        match chance.randrange(7):
            case 0 if out:
                out[min(at, len(out) - 1)] ^= 1 << chance.randrange(8)
            case 1:
                del out[at:to]
            case 2:
                out[at:at] = chance.choice(_WORDS) * chance.choice((1, 1, 1, 3, 100))
            case 3:
                out[at:at] = out[at:to] * chance.choice((1, 2, 20))
            case 4:
                out[at:to] = bytes(chance.randrange(256) for _ in range(min(to - at, 8)))
            case 5:
                out[at : at + 1] = chance.choice(_WORDS)
            case _:
                digits = [n for n in range(at, to) if chr(out[n]).isdigit()]
                for n in digits[:2]:
                    out[n : n + 1] = chance.choice((b"-1", b"0", b"9999999999", b"1e400", b".5", b"'x'", b"[]"))
    return bytes(out[:2_000_000])


class _TooLongError(Exception):
    pass


def attempt(kind: str, data: bytes, folder: Path) -> str | None:
    """A traceback if the reader of this kind fails on some data; None if it does not."""

    def alarm(_number: int, _frame: object) -> None:
        raise _TooLongError(f"takes more than {LONGEST} s")

    suffix, reader = KINDS[kind]
    path = folder / f"x{suffix}"
    path.write_bytes(data)
    has_alarm = hasattr(signal, "SIGALRM")
    if has_alarm:
        signal.signal(signal.SIGALRM, alarm)
        signal.alarm(LONGEST)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", RuntimeWarning)  # a sum that overflows is a find, too
            reader(path)
    except DancetutorError as error:
        return "an error of several lines" if "\n" in str(error) else None
    except Exception:
        return traceback.format_exc()
    finally:
        if has_alarm:
            signal.alarm(0)
    return None


def fuzz(minutes: float, seed: int, kinds: list[str]) -> int:
    """Try until the time is over; the number of finds."""
    chance = random.Random(seed)
    whole = {kind: seeds(kind) for kind in kinds}
    tried: Counter[str] = Counter()
    finds: Counter[str] = Counter()
    seen: set[str] = set()
    with tempfile.TemporaryDirectory() as name:
        for kind in kinds:
            for data in whole[kind][:3]:
                attempt(kind, data, Path(name))  # compiles
        end = time.monotonic() + 60 * minutes
        while time.monotonic() < end:
            kind = chance.choice(kinds)
            data = chance.choice(whole[kind])
            data = swapped(data, chance) if kind in _JSON and chance.random() < 0.6 else mutated(data, chance)
            tried[kind] += 1
            wrong = attempt(kind, data, Path(name))
            if wrong is None:
                continue
            finds[kind] += 1
            place = "\n".join(wrong.splitlines()[-3:])
            if place in seen:
                continue
            seen.add(place)
            FINDS.mkdir(parents=True, exist_ok=True)
            file = FINDS / f"{kind}-{hashlib.sha256(data).hexdigest()[:8]}{KINDS[kind][0]}"
            file.write_bytes(data)
            print(f"{file.relative_to(ROOT)}\n{wrong}", flush=True)
    for kind in kinds:
        print(f"{kind:<14} {tried[kind]:>7} tried {finds[kind]:>5} finds")
    print(f"{sum(tried.values())} inputs in {minutes:g} minutes with seed {seed}: {sum(finds.values())} finds")
    return sum(finds.values())


def main() -> int:
    """Run as a program; exit status 1 if something was found."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=10)
    parser.add_argument("--seed", type=int, default=int(time.time()))
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=list(KINDS))
    given = parser.parse_args()
    return 1 if fuzz(given.minutes, given.seed, given.kinds) else 0


if __name__ == "__main__":
    sys.exit(main())
