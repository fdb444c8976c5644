"""What rules about pictures share: whether the one that a song names is there and has a usual size or proportion."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Song
    from dancetutor_cli.lint.subject import FileSubject

_FILMS = (".avi", ".mpg", ".mpeg", ".mp4", ".m4v", ".mkv", ".webm", ".ogv", ".mov", ".wmv", ".flv")
_ALIKE = 0.02  # by so much of it a proportion may differ


class PictureRule(FileRule):
    """A rule about the picture that a tag of the song names. `tag` : its name

    Options: `sizes` and `proportions`, as "418x164", of which it has one; `required`
    """

    tag: ClassVar[str]
    about_tags = True

    @classmethod
    def fault(cls, option: str, value: Any) -> str | None:
        """Sizes that are none."""
        return sizes_fault(value) if option in ("sizes", "proportions") else None

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """At most one finding."""
        if fault := self._picture_fault(subject.song):
            yield self.finding(fault, subject.tag_place(self.tag))

    def _picture_fault(self, song: Song) -> str | None:
        """What is wrong with the picture, or None."""
        from dancetutor_cli.chart.music import named_file

        name = song.tags.get(self.tag, "").strip()
        if not name:
            return f"#{self.tag} is empty" if self.options["required"] else None
        folder = song.path.resolve().parent
        path = named_file(folder, name).resolve()
        if not path.is_relative_to(folder.parent):
            return f"#{self.tag} names a file outside the pack: {name}"
        if not path.is_file():
            return f"#{self.tag} names a file that is not there: {name}"
        if not path.stat().st_size:
            return f"#{self.tag} names a file that is empty: {name}"
        if path.suffix.lower() in _FILMS:
            return None
        size = picture_size(path)
        if size is None:
            return f"#{self.tag} names a file that is not a picture: {name}"
        return self._size_fault(size, name)

    def _size_fault(self, size: tuple[int, int], name: str) -> str | None:
        sizes, proportions = self.options["sizes"], self.options["proportions"]
        start = f"#{self.tag} is {size[0]}x{size[1]}, not"
        if sizes and f"{size[0]}x{size[1]}" not in sizes:
            return f"{start} {' or '.join(sizes)}: {name}"
        ratios = [int(a) / int(b) for a, b in (str(one).split("x") for one in proportions)]
        if ratios and all(abs(size[0] / size[1] / ratio - 1) > _ALIKE for ratio in ratios):
            return f"{start} in the proportion of {' or '.join(proportions)}: {name}"
        return None


def sizes_fault(sizes: Sequence[object]) -> str | None:
    """What is wrong with a list of sizes, or None."""
    wrong = [size for size in sizes if not re.fullmatch(r"[1-9]\d*x[1-9]\d*", str(size))]
    return f"'{wrong[0]}' is not a size; write it as 418x164" if wrong else None


def picture_size(path: Path) -> tuple[int, int] | None:
    """Width and height by the head of a picture, which is all that is read of it; None for what is none."""
    import warnings

    from PIL import Image

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of sizes that nobody decodes here
            with Image.open(path) as picture:
                return picture.size if min(picture.size) > 0 else None
    except (OSError, ValueError, SyntaxError, MemoryError, Image.DecompressionBombError):
        return None
