"""What rules about pictures share: whether the one that a song names is there and has a usual size."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, ClassVar

from dancetutor_cli.lint.finding import Finding
from dancetutor_cli.lint.rule import FileRule

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Song
    from dancetutor_cli.lint.subject import FileSubject


class PictureRule(FileRule):
    """A rule about the picture that a tag of the song names. `tag` : its name; options `sizes` and `required`"""

    tag: ClassVar[str]

    @classmethod
    def fault(cls, option: str, value: Any) -> str | None:
        """Sizes that are none."""
        return sizes_fault(value) if option == "sizes" else None

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """At most one finding."""
        fault = picture_fault(subject.song, self.tag, self.options["sizes"], required=self.options["required"])
        if fault:
            yield self.finding(fault, subject.tag_place(self.tag))


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
