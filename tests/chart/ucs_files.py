"""A .ucs written from what a test knows: blocks of (BPM, delay in ms, rows a beat, rows)."""

from __future__ import annotations

from collections.abc import Sequence

Block = tuple[str, str, int, Sequence[str]]
DEMO: tuple[Block, ...] = (
    ("120", "500", 2, ["X....", "....X", "..X..", ".....", "M....", "H...X", "W....", "....."]),
    ("240", "250", 4, ["...X.", ".....", "X....", "..X..", "....X", ".....", ".X...", "....."]),
)


def written(blocks: Sequence[Block], mode: str = "Single", newline: str = "\r\n", beat: int = 4) -> bytes:
    """The bytes of a file of such blocks."""
    lines = [":Format=1", f":Mode={mode}"]
    for bpm, delay, split, rows in blocks:
        lines += [f":BPM={bpm}", f":Delay={delay}", f":Beat={beat}", f":Split={split}", *rows]
    return (newline.join(lines) + newline).encode("ascii")
