"""Rules about music that is not on the beats: with a bias, half a beat off, drifting, or mixed in a pack."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import ITG, NULL, Finding
from dancetutor_cli.lint.rule import PackRule, PackSong, SyncRule

if TYPE_CHECKING:
    from dancetutor_cli.chart.pack_files import PackIni
    from dancetutor_cli.lint.findings import Sync
    from dancetutor_cli.lint.subject import FileSubject


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
