"""Rules about the tags of a song: title and artist, credit, pictures, tempo and folder."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from dancetutor_cli.chart.names import is_lights
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import ChartRule, FileRule

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.lint.subject import ChartSubject, FileSubject

# The base of rules about pictures: whether the named picture exists and has a usual size or proportion.

_FILMS = (".avi", ".mpg", ".mpeg", ".mp4", ".m4v", ".mkv", ".webm", ".ogv", ".mov", ".wmv", ".flv")
_ALIKE = 0.02  # share by which a proportion may differ


class PictureRule(FileRule):
    """A rule about the picture that a tag of the song names. `tag` : name of the tag

    Options: `sizes` and `proportions`, such as "418x164", of which the picture must have one; `required`
    """

    tag: ClassVar[str]
    about_tags = True

    @classmethod
    def fault(cls, option: str, value: Any) -> str | None:
        """Return what is wrong with a list of sizes or proportions, or None."""
        return sizes_fault(value) if option in ("sizes", "proportions") else None

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """At most one finding."""
        if fault := self._picture_fault(subject.song):
            yield self.finding(fault, subject.tag_place(self.tag))

    def _picture_fault(self, song: Song) -> str | None:
        """Return what is wrong with the picture, or None."""
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
    """Return what is wrong with a list of sizes, or None."""
    wrong = [size for size in sizes if not re.fullmatch(r"[1-9]\d*x[1-9]\d*", str(size))]
    return f"'{wrong[0]}' is not a size; write it as 418x164" if wrong else None


def picture_size(path: Path) -> tuple[int, int] | None:
    """Return width and height of a picture, reading only its head; None if the file is not a picture."""
    import warnings

    from PIL import Image

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # PIL warns of large sizes, but nothing is decoded here
            with Image.open(path) as picture:
                return picture.size if min(picture.size) > 0 else None
    except (OSError, ValueError, SyntaxError, MemoryError, Image.DecompressionBombError):
        return None


_TAGS = ("MUSIC", "BANNER", "BACKGROUND", "CDTITLE", "JACKET", "LYRICSPATH")


class LetterCase(FileRule):
    """A tag and the file that it names differ in capitals: Windows and the games find the file, other systems do not.

    Bad: #MUSIC:Song.OGG; beside song.ogg. Better: #MUSIC:song.ogg;
    """

    code = "DT112"
    name = "letter-case"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding for each tag."""
        from dancetutor_cli.chart.music import other_case

        folder = subject.song.path.parent
        for tag in _TAGS:
            name = subject.song.tags.get(tag, "").strip()
            if name and (there := other_case(folder, name)):
                yield self.finding(f"#{tag} names {name}, but the file is called {there}", subject.tag_place(tag))


class BannerSize(PictureRule):
    """#BANNER is empty, names a missing or empty file, or a picture of an unusual size.

    `required`: whether a song without the tag is reported.
    `sizes`: the accepted sizes, such as "418x164".
    `proportions`: sizes whose proportions are accepted. An empty list accepts all. The size of a video is not checked.

    Bad: #BANNER:nowhere.png; Better: a picture of 418x164 beside the song.
    """

    code = "DT504"
    name = "banner-size"
    tag = "BANNER"


class BackgroundSize(PictureRule):
    """#BACKGROUND is empty, names a missing or empty file, or a picture of an unusual size.

    `required`: whether a song without the tag is reported.
    `sizes`: the accepted sizes, such as "1920x1080".
    `proportions`: sizes whose proportions are accepted. An empty list accepts all. The size of a video is not checked.

    Bad: #BACKGROUND:nowhere.png; Better: a picture of 1920x1080 beside the song.
    """

    code = "DT505"
    name = "background-size"
    tag = "BACKGROUND"


class BpmRange(ChartRule):
    """A BPM of the chart's timing is outside the limits. Off by default; contests switch it on.

    `min_bpm`, `max_bpm`: the limits.

    Bad for a contest of 60 to 200 BPM: #BPMS:0=240; Better: #BPMS:0=120;
    """

    code = "DT507"
    name = "bpm-range"

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """At most one finding, for the first tempo outside the limits."""
        for bpm in subject.tempos():
            if not self.options["min_bpm"] <= bpm <= self.options["max_bpm"]:
                low, high = self.options["min_bpm"], self.options["max_bpm"]
                yield self.finding(f"a tempo of {bpm:g} BPM, not {low:g} to {high:g} BPM", subject.at_chart())
                break


class CdTitle(PictureRule):
    """#CDTITLE is empty, names a missing or empty file, or a picture of an unusual size.

    `required`: whether a song without the tag is reported.
    `proportions`: the accepted proportions of width and height.
    `sizes`: the accepted sizes; an empty list accepts all.

    Bad: #CDTITLE:nowhere.png; Better: a picture beside the song, or in the pack's folder: ../pack.png.
    """

    code = "DT511"
    name = "cdtitle"
    tag = "CDTITLE"


_SCRIPTS = ("CJK", "HIRAGANA", "KATAKANA", "HANGUL", "CYRILLIC", "ARABIC", "HEBREW", "THAI", "DEVANAGARI", "GREEK")
_LEAST = {"GREEK": 3}  # the least letters of a word, because single letters are symbols


class Translit(FileRule):
    """Title, subtitle or artist is not in Latin letters, and no transliteration is given.

    Players who cannot read the letters cannot search for the song, and some fonts of the games lack the letters.

    Bad: #TITLE:\u65e5\u672c; without #TITLETRANSLIT. Better: #TITLETRANSLIT:Nihon;
    """

    code = "DT513"
    name = "translit"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding for each tag."""
        for tag in ("TITLE", "SUBTITLE", "ARTIST"):
            value = subject.song.tags.get(tag, "")
            if _is_other_script(value) and not subject.song.tags.get(f"{tag}TRANSLIT", "").strip():
                yield self.finding(
                    f"#{tag} is not in Latin letters; write it in Latin letters in #{tag}TRANSLIT",
                    subject.tag_place(tag),
                )


def _is_other_script(text: str) -> bool:
    import unicodedata

    if text.isascii():
        return False
    scripts = [unicodedata.name(letter, "").split(" ")[0].split("-")[0] for letter in text if letter.isalpha()]
    return any(scripts.count(script) >= _LEAST.get(script, 1) for script in _SCRIPTS)


_ROOTS = ("songs", "additionalsongs")


class SongFolder(FileRule):
    """The song's folder or its file is directly in Songs: the games look for songs in the folders of packs.

    Bad: Songs/My Song/song.ssc. Better: Songs/My Pack/My Song/song.ssc
    """

    code = "DT514"
    name = "song-folder"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """At most one finding."""
        folder = subject.song.path.absolute().parent
        if folder.name.lower() in _ROOTS:
            yield self.finding(f"the file is directly in {folder.name}, in no folder of a pack", subject.place())
        elif folder.parent.name.lower() in _ROOTS:
            message = f"the song's folder is directly in {folder.parent.name}, in no folder of a pack"
            yield self.finding(message, subject.place())


class Title(FileRule):
    """Title or artist is missing, or only blanks. The games remove blanks at the ends of other titles.

    Bad: #TITLE:; Better: #TITLE:Two Left Feet;
    """

    code = "DT501"
    name = "title"
    about_tags = True

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding for each tag that is empty."""
        for tag in ("TITLE", "ARTIST"):
            if not subject.song.tags.get(tag, "").strip():
                yield self.finding(f"#{tag} is empty", subject.tag_place(tag))


class Credit(FileRule):
    """Neither the song's #CREDIT nor the chart's own credit (in .sm: its description) names the author of a chart.

    Bad: #CREDIT:; Better: #CREDIT:A. Stepartist;
    """

    code = "DT502"
    name = "credit"
    about_tags = True

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """At most one finding, for all charts without an author."""
        if subject.song.tags.get("CREDIT", "").strip():
            return
        charts = [chart for chart in subject.song.charts if not is_lights(chart.steps_type)]
        anonymous = [chart for chart in charts if not (chart.tags.get("CREDIT", "") + chart.description).strip()]
        if not anonymous:
            return
        message, place = "the charts name no author", subject.tag_place("CREDIT")
        if len(anonymous) < len(charts):
            message, place = f"no author is named for {_labels(anonymous)}", subject.place(anonymous[0].line)
        yield self.finding(f"{message}, and #CREDIT is empty; write the name there", place)


_MOST_LABELS = 3  # most charts that a message names


def _labels(charts: list[Chart]) -> str:
    more = len(charts) - _MOST_LABELS
    named = ", ".join(chart.label for chart in charts[:_MOST_LABELS])
    return f"{named} and {more} more" if more > 0 else named
