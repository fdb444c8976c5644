"""The rows around a finding as arrows with L and R, in characters."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from dancetutor_cli.colours import hex_colour, limb_colours
from dancetutor_cli.lint.finding import ExcerptRow

_ASCII = str.maketrans("←↓↑→↙↖■↗↘│·●", "<v^>/\\o/\\|.*")
_LIMB_OF = {"L": 0, "l": 0, "R": 1, "r": 1, "<": 2, ">": 3}
Paint = Callable[[str, str], str]


def draw(rows: Sequence[ExcerptRow], arrows: str, paint: Paint, *, plain: bool) -> Iterator[str]:
    """A line for each row; `arrows` has a sign per column, `paint(text, style)` colours, `plain` keeps to ASCII."""
    measure = -1
    for row in rows:
        shown = f"measure {int(row.beat // 4):<4}" if row.beat // 4 != measure else ""
        measure = int(row.beat // 4)
        mark = paint(">", "bold red") if row.here else " "
        beat = f"beat {row.beat:<8.8g}"
        cells = "".join(_cell(note, limb, sign, paint) for note, limb, sign in _columns(row, arrows))
        line = f"    {mark} {paint(f'{shown:12} {beat}', 'dim')}{cells}"
        yield line.translate(_ASCII) if plain else line


def _columns(row: ExcerptRow, arrows: str) -> Iterator[tuple[str, str, str]]:
    yield from zip(row.notes, row.limbs, arrows.ljust(len(row.notes), "■"), strict=False)


def _cell(note: str, limb: str, sign: str, paint: Paint) -> str:
    """Three characters: a blank, the sign, who presses it."""
    if note == " ":
        return paint(" · ", "dim")
    if note == "|":
        return paint(" │ ", "dim")
    if note == "M":
        return paint(" ● ", "red")
    if limb in _LIMB_OF:
        return " " + paint(f"{sign}{limb}", f"bold {hex_colour(limb_colours().by_limb[_LIMB_OF[limb]])}")
    return " " + paint(f"{sign}?", "bold red")
