"""Rules about files that cannot be read, or that games and tools read differently."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule, ReaderRule

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.lint.subject import ChartSubject, FileSubject


class Unreadable(FileRule):
    """The file cannot be opened, is not a .sm, .ssc or .ucs file, or has no chart. The exit status is 2.

    Bad: an empty file. Better: save it again from the editor.
    """

    code = "DT101"
    name = "unreadable"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """Return nothing, because the subject could be read; `lint.analysis` makes the finding if reading fails."""
        return ()


class DifferingPair(FileRule):
    """The song has a .sm and a .ssc with different charts: some games read one, some the other.

    It is reported for the .ssc, which newer games read.

    Bad: an edit in the .ssc that the .sm never got.

    Better: save both from the editor, or remove the .sm.
    """

    code = "DT109"
    name = "differing-pair"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding for the pair, at the first chart that is different or missing."""
        from dancetutor_cli.lint.note_facts import differences

        if found := list(differences(subject.song)):
            _, line, index = found[0]
            sentence = "; ".join(message for message, _, _ in found)
            yield self.finding(sentence, subject.place(line), chart=index if len(found) == 1 else None)


class OddChart(ReaderRule):
    """A chart lacks its steps type, its notes or a field, or its steps type is unknown.

    The games skip such a chart, or read its tags as part of the next one.

    Bad: a #NOTEDATA without #NOTES.

    Better: every chart with #STEPSTYPE and #NOTES.
    """

    code = "DT110"
    name = "odd-chart"
    codes = frozenset({"chart-skipped", "notedata-without-notes", "unknown-steps-type"})


_ENDED = ("BPMS", "STOPS", "DELAYS", "WARPS", "OFFSET", "DISPLAYBPM")


class TwoReadings(FileRule):
    """A `;` is missing after a timing tag, or #DISPLAYBPM is written like #BPMS: programs read the value differently.

    The games end a value where a line starts with `#`; other programs read on to the next `;`. For #DISPLAYBPM:0=120;
    the games show 0.

    Bad: #BPMS:0.000=120.000 without `;`. Better: #BPMS:0.000=120.000;
    """

    code = "DT113"
    name = "two-readings"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding for each tag."""
        from dancetutor_cli.chart.msd import scan

        data = subject.song.data
        for tag in scan(data):
            if tag.name not in _ENDED or not tag.spans:
                continue
            place = subject.place(data.count(b"\n", 0, tag.start) + 1)
            end = tag.spans[-1][1]
            if data[end : end + 1] != b";":
                yield self.finding(f"no ';' after #{tag.name}", place)
            elif tag.name == "DISPLAYBPM" and any(b"=" in data[a:b] for a, b in tag.spans):
                yield self.finding("#DISPLAYBPM has a '='; write one BPM, two such as 90:180, or *", place)


_MODIFIERS = ("ATTACKS", "MODS")
_CHANGES = ("BGCHANGES", "FGCHANGES", "BGCHANGES2")


class Attacks(FileRule):
    """The song has attacks (modifiers that appear during play) or Lua scripts. Off by default.

    Bad for a tournament: #ATTACKS:TIME=1.0:LEN=4:MODS=drunk; Better: #ATTACKS:;
    """

    code = "DT115"
    name = "attacks"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding for attacks of the song, of each chart, and for scripts."""
        song = subject.song
        for tag in _MODIFIERS:
            if song.tags.get(tag, "").strip():
                yield self.finding(f"#{tag} changes how the song is played", subject.tag_place(tag))
            for chart in subject.dance_charts:
                if chart.tags.get(tag, "").strip():
                    words = f"#{tag} changes how {chart.label} is played"
                    yield self.finding(words, subject.place(chart.line), chart=chart.index)
        for tag in _CHANGES:
            for entry in song.tags.get(tag, "").split(","):
                name = entry.split("=")[1].strip() if entry.count("=") else ""
                if name and _is_script(subject, name):
                    yield self.finding(f"#{tag} runs a script: {name}", subject.tag_place(tag))
                    break


def _is_script(subject: FileSubject, name: str) -> bool:
    """Whether a background change names a Lua file, or a folder below the song's folder with a default.lua."""
    from dancetutor_cli.chart.music import named_file
    from dancetutor_cli.run.reading import is_outside, is_regular

    if name.lower().endswith(".lua"):
        return True
    folder = subject.song.path.parent
    path = named_file(folder, name)
    return not is_outside(path, folder) and is_regular(named_file(path, "default.lua"))


class OddTag(ReaderRule):
    """A tag has a wrong value: a decimal comma, a meter that is not a number, a difficulty that no game knows.

    If no player sees the lost value, such as that of MENUCOLOR, it is an info.

    Bad: #OFFSET:1,5;

    Better: #OFFSET:1.5;
    """

    code = "DT104"
    name = "odd-tag"
    codes = frozenset(
        {
            "odd-offset",
            "odd-directive",
            "odd-meter",
            "odd-difficulty",
            "odd-time-signature",
            "hash-in-value",
            "hash-in-unused-value",
            "nul-byte",
            "cr-only",
        }
    )
    usual = frozenset({"hash-in-unused-value"})


_LISTED = 5  # most other lines that a message lists


class OddNotes(ReaderRule):
    """Rows are too short or too long, characters are unknown, or rows are so close that one overwrites the other.

    Each game reads such notes in its own way; this program reads them as ITGmania does. StepF2's own notation,
    StepManiaX notes in charts of other games, and charts for several players are an info. The same problem in several
    rows of a chart is one finding, and so is a file without line breaks.

    Bad:

        1000  L
        001
        0x00
        0001  R

    Better:

        1000  L
        0010  R
        0100  L
        0001  R
    """

    code = "DT102"
    name = "odd-notes"
    codes = frozenset(
        {
            "compound-note",
            "odd-keysound",
            "long-row",
            "short-row",
            "unknown-note",
            "row-collision",
            "several-players",
            "stepf2-note",
            "stepmaniax-note",
        }
    )
    usual = frozenset({"several-players", "stepf2-note", "stepmaniax-note"})

    def check(self, subject: FileSubject | ChartSubject) -> Iterable[Finding]:
        """One finding for each odd thing, with its lines; for charts without line breaks, one in the first of them."""
        from dancetutor_cli.lint.subject import ChartSubject

        found = list(super().check(subject))
        if not found or not isinstance(subject, ChartSubject):
            return found
        if _flattened(subject.song, subject.chart):
            before = subject.song.charts[: subject.chart.index]
            if any(_flattened(subject.song, chart) for chart in before):
                return []
            words = "the line breaks are missing: the rows of a measure are read as one long row"
            return [replace(found[0], message=words)]
        alike: dict[tuple[str, str], list[Finding]] = {}
        for one in found:
            alike.setdefault((one.message, one.severity), []).append(one)
        return [_with_lines(same) for same in alike.values()]


def _with_lines(same: list[Finding]) -> Finding:
    """Return the first of several findings with the same message, with the lines of the others."""
    lines = [str(one.line) for one in same]
    if len(lines) == 1:
        return same[0]
    more = f"{', '.join(lines[: _LISTED + 1])}{' ...' if len(lines) > _LISTED + 1 else ''}"
    return replace(same[0], message=f"{same[0].message}; {len(same)} rows are like this, on lines {more}")


def _flattened(song: Song, chart: Chart) -> bool:
    """Whether all measures of a chart are on one line, so that each is read as one row."""
    start, end = chart.notes_span
    text = song.data[start:end].strip()
    return b"\n" not in text and b"\r" not in text and text.count(b",") > 0
