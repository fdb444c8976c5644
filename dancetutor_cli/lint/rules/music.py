"""Rules about the music: its file (missing, refused, too short, silent or cut off), and whether it is on the beats."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import ITG, NULL, Finding
from dancetutor_cli.lint.rule import FileRule, PackRule, PackSong, SyncRule
from dancetutor_cli.run.errors import FileError

if TYPE_CHECKING:
    from dancetutor_cli.chart.pack_files import PackIni
    from dancetutor_cli.lint.findings import Sync
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


# Rules about music that is not on the beats: with a bias, half a beat off, drifting, or mixed in a pack.


class SyncDrift(SyncRule):
    """The sync drifts: the music moves off the beats between the first and the last third, so the BPM is slightly off.

    `most`: drifts of at most this many ms are not reported. Needs `--sync`; `--plot FILE.svg` shows where it drifts.

    Bad: #BPMS:0=140.01; for music of 140 BPM: 9 ms in two minutes. Better: #BPMS:0=140;
    """

    code = "DT602"
    name = "sync-drift"
    tag = "BPMS"

    def message(self, sync: Sync, subject: FileSubject) -> str | None:
        """Return the message with the drift, and with the right tempo for a song of one tempo; None if it is small."""
        drift = sync.drift_ms
        if drift is None or abs(drift) <= self.options["most"]:
            return None
        return f"the music drifts by {drift:+.1f} ms from the first to the last third{self._tempo(drift, subject)}"

    def _tempo(self, drift: float, subject: FileSubject) -> str:
        found = subject.sync.judgement if subject.sync else None
        bpms = {bpm for _, bpm in subject.song.timing.bpms}
        if found is None or found.sync.drift_ms != drift or len(bpms) > 1:
            return ""
        bpm = float(next(iter(bpms)))
        right = bpm * (1 - drift / 1000 / ((found.last - found.first) * 2 / 3))
        return f", so the tempo is {right:.3f} BPM rather than {bpm:.3f}"


class BeatOff(SyncRule):
    """The chart is half a beat off, or nearly: its beats fall on the off-beats of the music.

    It is reported from a quarter beat on.

    Needs `--sync`.

    Bad: #OFFSET:0.250; at 120 BPM with music that is at the beats. Better: #OFFSET:0.000;
    """

    code = "DT603"
    name = "beat-off"

    def message(self, sync: Sync, subject: FileSubject) -> str | None:
        """Return the message with the bias, or None."""
        if sync.bias_ms is None or not sync.beat_off:
            return None
        side = "after" if sync.bias_ms > 0 else "before"
        change = f"change #OFFSET by {-sync.bias_ms / 1000:+.3f}, or as much the other way"
        return f"the music is {abs(sync.bias_ms):.1f} ms {side} the beats, about half a beat; {change}"


_KINDS = {"null": "null", "itg": "ITG"}
_LISTED = 5


class MixedSync(PackRule):
    """Some songs of the pack use null sync (on the beats), others ITG sync (9 ms after them): no setting suits both.

    `least`: the least number of songs of the rarer kind that is reported. Needs `--sync`.

    Bad: ten songs at 0 ms and two at 9 ms. Better: all at one of them, and #OFFSET of the others changed.
    """

    code = "DT604"
    name = "mixed-sync"

    def check_pack(self, songs: Sequence[PackSong], ini: PackIni | None) -> str | None:
        """Return the message, which names the songs of the rarer kind, or None."""
        kinds = {kind: [one.folder for one in songs if one.sync.kind == kind] for kind in _KINDS}
        rarer, usual = sorted(kinds, key=lambda kind: len(kinds[kind]))
        if len(kinds[rarer]) < self.options["least"]:
            return None
        more = f" and {len(kinds[rarer]) - _LISTED} more" if len(kinds[rarer]) > _LISTED else ""
        listed = f"{', '.join(kinds[rarer][:_LISTED])}{more}"
        many, few = (_count(len(kinds[kind]), _KINDS[kind]) for kind in (usual, rarer))
        return f"{many} sync, {few} sync: {listed}"


def _count(count: int, kind: str) -> str:
    return f"{count} song{' uses' if count == 1 else 's use'} {kind}"


_SHARE = 0.6  # the least share of other songs among the songs that are null or ITG
_KINDS_OF_INI = {"NULL": "null", "ITG": "itg"}


class PackSync(PackRule):
    """`SyncOffset` in Pack.ini says NULL and most songs are ITG, or the other way round.

    ITGmania shifts the songs by that setting.

    `least`: the least number of songs with a sure sync. Needs `--sync`.

    Bad: SyncOffset=ITG with songs at 0 ms. Better: SyncOffset=NULL
    """

    code = "DT605"
    name = "pack-sync"

    def check_pack(self, songs: Sequence[PackSong], ini: PackIni | None) -> str | None:
        """Return the message with the setting and the kind of most songs, or None."""
        word = "" if ini is None else ini.sync.upper()
        decided = [one for one in songs if one.sync.kind in _KINDS_OF_INI.values()]
        others = [one for one in decided if one.sync.kind != _KINDS_OF_INI.get(word)]
        if word not in _KINDS_OF_INI or len(decided) < self.options["least"] or len(others) < _SHARE * len(decided):
            return None
        (is_said,) = (name for name in _KINDS_OF_INI if name != word)
        return f"Pack.ini says SyncOffset={word}, but {len(others)} of {len(decided)} songs are {is_said}"


class SyncBias(SyncRule):
    """The music is neither on the beats (null) nor 9 ms after them (ITG): players hear that it is off.

    `tolerance`: differences of at most this many ms from both are not reported. Needs `--sync`. A song that is half a
    beat off is reported by DT603. A file without #OFFSET is reported too: the games take 0.

    Bad: #OFFSET:0.025; with music that is at the beats. Better: #OFFSET:0.000;
    """

    code = "DT601"
    name = "sync-bias"
    about_tags = True

    def check(self, subject: FileSubject) -> Iterable[Finding]:
        """Yield a finding for a file without #OFFSET, and the findings for its syncs."""
        if subject.sync is not None and "OFFSET" not in subject.song.tags:
            yield self.finding("there is no #OFFSET; the games use 0 s", subject.place())
        yield from super().check(subject)

    def message(self, sync: Sync, subject: FileSubject) -> str | None:
        """Return the message with the changes of #OFFSET for null sync and for ITG sync, or None."""
        bias = sync.bias_ms
        if bias is None or sync.beat_off or min(abs(bias - NULL), abs(bias - ITG)) <= self.options["tolerance"]:
            return None
        side = "after" if bias > 0 else "before"
        to = [f"{(one - bias) / 1000:+.3f} for {name}" for one, name in ((NULL, "null"), (ITG, "ITG"))]
        return f"the music is {abs(bias):.1f} ms {side} the beats; change #OFFSET by {' or '.join(to)}"
