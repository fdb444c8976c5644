"""DT608: music that the games do not play, or not all of them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import FileSubject


_SUFFIXES = {".ogg": "vorbis", ".oga": "vorbis", ".mp3": "mp3", ".wav": "wav", ".flac": "flac", ".opus": "opus"}


class MusicFormat(FileRule):
    """The music is damaged, empty, of a format or sample rate that games refuse, or another one than its name says.

    `formats`: of vorbis, mp3, wav, flac, opus those that are accepted. `rates`: accepted sample rates in Hz; an empty
    list accepts all. `channels`: at most so many.

    Bad: song.ogg that holds Opus. Better: Ogg Vorbis at 44100 Hz.
    """

    code = "DT608"
    name = "music-format"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """At most one finding."""
        from dancetutor_cli.chart.audio import read_head
        from dancetutor_cli.chart.music import music_file
        from dancetutor_cli.run.errors import FileError

        try:
            path = music_file(subject.song)
        except FileError:  # DT107 says so
            return
        try:
            head = read_head(path)
        except FileError as error:
            yield self.finding(f"the music {path.name} {error.message}", subject.tag_place("MUSIC"))
            return
        formats, rates = self.options["formats"], self.options["rates"]
        named = _SUFFIXES.get(path.suffix.lower())
        said = None
        if head.kind not in formats:
            said = f"is {head.kind}, not {' or '.join(formats)}"
        elif named != head.kind:
            said = f"is {head.kind}, whatever its name says"
        elif rates and head.rate not in rates:
            said = f"has {head.rate} samples a second, not {' or '.join(map(str, rates))}"
        elif head.channels > self.options["channels"]:
            said = f"has {head.channels} channels, more than {self.options['channels']}"
        elif subject.sync is not None and subject.sync.damage:
            said = "cannot be decoded"
        if said:
            yield self.finding(f"the music {path.name} {said}", subject.tag_place("MUSIC"))
