"""DT115: a song that changes the game while it is played."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import FileSubject


_MODIFIERS = ("ATTACKS", "MODS")
_CHANGES = ("BGCHANGES", "FGCHANGES", "BGCHANGES2")


class Attacks(FileRule):
    """The song has attacks (modifiers that come while it is played), or scripts in Lua. Off by default.

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
    from dancetutor_cli.run.reading import is_regular, leads_out

    if name.lower().endswith(".lua"):
        return True
    folder = subject.song.path.parent
    path = named_file(folder, name)
    return not leads_out(path, folder) and is_regular(named_file(path, "default.lua"))
