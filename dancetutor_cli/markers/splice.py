"""Changes to a file's bytes as a list of small replacements; everything between them stays as it is."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, order=True)
class Splice:
    """Put `text` in place of `data[start:end]`."""

    start: int
    end: int
    text: bytes


def apply(data: bytes, splices: Iterable[Splice]) -> bytes:
    """`data` with all replacements made. They must not overlap."""
    out: list[bytes] = []
    at = 0
    for splice in sorted(splices):
        if splice.start < at:
            raise ValueError(f"replacements overlap at byte {splice.start}")
        out += (data[at : splice.start], splice.text)
        at = splice.end
    out.append(data[at:])
    return b"".join(out)
