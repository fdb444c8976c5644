"""How a file is written: what cannot be read, or is read differently by games and tools."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule, ReaderRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import FileSubject


class Unreadable(FileRule):
    """The file cannot be opened, is not a .sm, .ssc or .ucs file, or has no chart. The exit status is 2.

    Bad: an empty file. Better: save it again from the editor.
    """

    code = "DT101"
    name = "unreadable"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """Nothing: a file that can be read is not unreadable; the finding is made where reading fails."""
        return ()


class DifferingPair(FileRule):
    """The song has a .sm and a .ssc with different charts: games that read the one play something else than the others.

    Reported for the .ssc, which newer games load.

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

    The games skip such a chart or mix it up with the next one.

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
                    said = f"#{tag} changes how {chart.label} is played"
                    yield self.finding(said, subject.place(chart.line), chart=chart.index)
        for tag in _CHANGES:
            for entry in song.tags.get(tag, "").split(","):
                name = entry.split("=")[1].strip() if entry.count("=") else ""
                if name and _is_script(subject, name):
                    yield self.finding(f"#{tag} runs a script: {name}", subject.tag_place(tag))
                    break


def _is_script(subject: FileSubject, name: str) -> bool:
    """Whether a change of the background is Lua: a file of it, or a folder in the song's with a default.lua."""
    from dancetutor_cli.chart.music import named_file
    from dancetutor_cli.run.reading import is_outside, is_regular

    if name.lower().endswith(".lua"):
        return True
    folder = subject.song.path.parent
    path = named_file(folder, name)
    return not is_outside(path, folder) and is_regular(named_file(path, "default.lua"))
