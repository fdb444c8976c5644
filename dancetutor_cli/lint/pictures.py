"""Whether a picture that a song names is there and has a usual size."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Song


def sizes_fault(sizes: Sequence[object]) -> str | None:
    """What is wrong with a list of sizes, or None."""
    wrong = [size for size in sizes if not re.fullmatch(r"[1-9]\d*x[1-9]\d*", str(size))]
    return f"'{wrong[0]}' is no size; write it as 418x164" if wrong else None


def picture_fault(song: Song, tag: str, sizes: Sequence[str], *, required: bool) -> str | None:
    """What is wrong with the picture of a tag, or None. `sizes` as "418x164"; empty: every size is right."""
    name = song.tags.get(tag, "").strip()
    if not name:
        return f"#{tag} is empty" if required else None
    folder = song.path.resolve().parent
    path = (folder / name.replace("\\", "/")).resolve()
    if not path.is_relative_to(folder.parent):
        return f"#{tag} names a file outside the pack: {name}"
    if not path.is_file():
        return f"#{tag} names a file that is not there: {name}"
    if not sizes:
        return None
    from PIL import Image, UnidentifiedImageError

    try:
        with Image.open(path) as picture:
            width, height = picture.size
    except (OSError, UnidentifiedImageError, Image.DecompressionBombError):
        return f"#{tag} names a file that is no picture: {name}"
    return None if f"{width}x{height}" in sizes else f"#{tag} is {width}x{height}, not {' or '.join(sizes)}: {name}"
