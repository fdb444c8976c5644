"""Rules about the file of the music: missing, refused, too short, silent or cut off."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import FileRule
from dancetutor_cli.run.errors import FileError

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import FileSubject


class MissingMusic(FileRule):
    """The file that #MUSIC names is missing, is not an audio file, or is outside the song's folder.

    Bad: #MUSIC:C:/Users/me/song.ogg;

    Better: #MUSIC:song.ogg; with song.ogg beside the chart.
    """

    code = "DT107"
    name = "missing-music"
    codes = frozenset({"unsafe-music"})  # `check` looks for the music itself and reports the same and more

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """At most one finding."""
        from dancetutor_cli.chart.music import music_file

        try:
            music_file(subject.song)
        except FileError as error:
            yield self.finding(error.message, subject.tag_place("MUSIC"))


class MusicEnd(FileRule):
    """The last note of a chart, or the end of its last hold, comes after the end of the music.

    `tolerance`: notes at most this many seconds after the end are not reported.

    Bad: a chart of two minutes with the cut music of one. Better: the whole music, or a shorter chart.
    """

    code = "DT606"
    name = "music-end"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding, at the chart that goes on longest."""
        import numpy as np

        music = subject.music
        if music is None or music.seconds is None:
            return
        ends = [
            (float(one.timing.seconds(np.array([one.notes.last_tick]))[0]), one)
            for one in subject.dance_charts
            if not one.tags.get("MUSIC")
        ]
        last, chart = max(ends, key=lambda end: end[0], default=(0.0, None))
        if chart is not None and last > music.seconds + self.options["tolerance"]:
            message = f"{chart.label} goes on to {last:.1f} s, but the music ends at {music.seconds:.1f} s"
            yield self.finding(message, subject.place(chart.line), chart=chart.index)


class Preview(FileRule):
    """#SAMPLESTART and #SAMPLELENGTH name a part outside the music, or an empty one: the games play another part.

    `tolerance`: a preview that ends at most this many seconds after the music is not reported. Without the tags the
    games choose a part.

    Bad: #SAMPLELENGTH:0; Better: #SAMPLELENGTH:15;
    """

    code = "DT607"
    name = "preview"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """At most one finding."""
        from dancetutor_cli.chart.timing_tags import parse_number

        tags = {name: subject.song.tags.get(name, "").strip() for name in ("SAMPLESTART", "SAMPLELENGTH")}
        start, length = (float(parse_number(tags[name])[0]) if tags[name] else None for name in tags)
        end = subject.music.seconds if subject.music else None
        if length is not None and length <= 0:
            yield self.finding(f"the preview lasts {length:g} s", subject.tag_place("SAMPLELENGTH"))
        elif start is not None and start < 0:
            yield self.finding(f"the preview starts at {start:g} s, before the music", subject.tag_place("SAMPLESTART"))
        elif start is not None and end is not None and start + (length or 0) > end + self.options["tolerance"]:
            message = (
                f"the preview goes from {start:g} to {start + (length or 0):g} s, but the music ends at {end:.1f} s"
            )
            yield self.finding(message, subject.tag_place("SAMPLESTART"))


_SUFFIXES = {".ogg": "vorbis", ".oga": "vorbis", ".mp3": "mp3", ".wav": "wav", ".flac": "flac", ".opus": "opus"}


class MusicFormat(FileRule):
    """The music is damaged or empty, has a format or sample rate that games refuse, or is not what its name says.

    `formats`: the accepted ones of vorbis, mp3, wav, flac and opus. wav means WAV as StepMania and ITGmania read it: 8
    to 32 bits, 32-bit floats or ADPCM, without the extensible header that editors write for 24 bits.
    `rates`: accepted sample rates in Hz; an empty list accepts all.
    `channels`: the most channels that are accepted.

    Bad: song.ogg that holds Opus. Better: Ogg Vorbis at 44100 Hz.
    """

    code = "DT608"
    name = "music-format"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """At most one finding."""
        from dancetutor_cli.chart.audio import read_head
        from dancetutor_cli.chart.music import music_file

        try:
            path = music_file(subject.song)
        except FileError:  # DT107 reports it
            return
        try:
            head = read_head(path)
        except FileError as error:
            yield self.finding(f"the music {path.name} {error.message}", subject.tag_place("MUSIC"))
            return
        formats, rates = self.options["formats"], self.options["rates"]
        named = _SUFFIXES.get(path.suffix.lower())
        message = None
        if head.kind not in formats:
            message = f"is {head.kind}, not {' or '.join(formats)}"
        elif named != head.kind:
            message = f"is {head.kind}, whatever its name says"
        elif rates and head.rate not in rates:
            message = f"has a sample rate of {head.rate} Hz, not {' or '.join(map(str, rates))}"
        elif head.channels > self.options["channels"]:
            message = f"has {head.channels} channels, more than {self.options['channels']}"
        elif subject.sync is not None and subject.sync.damage:
            message = "cannot be decoded"
        if message:
            yield self.finding(f"the music {path.name} {message}", subject.tag_place("MUSIC"))


class LeadIn(FileRule):
    """The first note comes before the music, or too soon after its start for a player to be ready.

    `min_seconds`: the least time from the start of the music to the first note.

    Bad: a first note at second -0.5. Better: music with a second before the first note.
    """

    code = "DT609"
    name = "lead-in"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """One finding, at the chart that begins first."""
        starts = [(float(one.timing.seconds(one.notes.tick[:1])[0]), one) for one in subject.dance_charts]
        first, chart = min(starts, key=lambda start: start[0], default=(0.0, None))
        if chart is not None and first < self.options["min_seconds"]:
            message = f"the first note of {chart.label} comes {abs(first):.2f} s {'before' if first < 0 else 'after'}"
            yield self.finding(f"{message} the start of the music", subject.place(chart.line), chart=chart.index)


class Silence(FileRule):
    """The music begins with a long silence. Players have to wait through it.

    `max_seconds`: the longest silence at the start that is not reported. Needs `--sync`.

    Bad: ten seconds of nothing. Better: cut them off, and change #OFFSET by as much.
    """

    code = "DT610"
    name = "silence"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """At most one finding."""
        heard = subject.sync.heard if subject.sync else None
        if heard is not None and heard.silence > self.options["max_seconds"]:
            yield self.finding(f"the music begins with {heard.silence:.1f} s of silence", subject.tag_place("MUSIC"))


class Clipping(FileRule):
    """Many samples of the music are at full scale, because it is louder than its file can hold: it crackles.

    `share`: per cent of the samples that may be at full scale. Loud masters have up to half a per cent. Needs `--sync`.

    Bad: music amplified until its waves have flat tops. Better: the music as it was published.
    """

    code = "DT611"
    name = "clipping"

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """At most one finding."""
        heard = subject.sync.heard if subject.sync else None
        if heard is not None and 100 * heard.clipped > self.options["share"]:
            message = f"{100 * heard.clipped:.1f} % of the music's samples are at full scale"
            yield self.finding(message, subject.tag_place("MUSIC"))
