"""The sync of a file. Charts with the same timing and music are judged together, and each music is decoded once."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from dancetutor_cli.chart.audio import AudioHead, Sound, decode_music, read_head
from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.chart.music import music_file
from dancetutor_cli.chart.names import is_lights
from dancetutor_cli.chart.timing import Timing
from dancetutor_cli.lint.findings import Sync, sync_of
from dancetutor_cli.lint.sync import Judgement, Onsets, judge, onsets
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.ffmpeg import EncoderError

_MOST_GROUPS = 4  # most timings of one file that are judged, because each takes a tenth of a second
_KEPT = 2  # decoded music that is kept, because a song's .sm and .ssc follow each other


class Heard(NamedTuple):
    """The results that are kept of decoded music. silence : seconds of silence at its start; clipped : see `Sound`"""

    onsets: Onsets
    silence: float
    clipped: float


@dataclass(frozen=True, slots=True)
class SongSync:
    """The sync of a file.

    sync : the sync of the charts with the song's own timing and music; if none has, of the largest group of charts
    judgement : the same with the curves for a plot, None if it could not be judged
    of_charts : chart index -> sync, for charts with another timing or music
    heard : the song's music, None if it cannot be decoded; damage : the error of the decoder, or None
    """

    sync: Sync
    judgement: Judgement | None = None
    of_charts: Mapping[int, Sync] = field(default_factory=dict)
    heard: Heard | None = None
    damage: str | None = None


def song_sync(song: Song) -> SongSync:
    """Judge all charts of a file except lights. UnavailableError if ffmpeg is not installed."""
    charts = [chart for chart in song.charts if not is_lights(chart.steps_type) and len(chart.notes)]
    groups: dict[tuple[Timing, str], list[Chart]] = {}
    for chart in charts:
        groups.setdefault((chart.timing, chart.tags.get("MUSIC", "")), []).append(chart)
    if not groups:
        return SongSync(sync_of(None, 0.0, reason="it has no notes"))
    ranked = sorted(groups, key=lambda key: (key != (song.timing, ""), -len(groups[key])))
    main, *others = ranked[:_MOST_GROUPS]
    found = _judged(song, groups[main])
    of_charts = {chart.index: _judged(song, groups[key]).sync for key in others for chart in groups[key][:1]}
    for key in others:
        of_charts.update({chart.index: of_charts[groups[key][0].index] for chart in groups[key]})
    return SongSync(found.sync, found.judgement, of_charts, found.heard, found.damage)


def _judged(song: Song, charts: Sequence[Chart]) -> SongSync:
    """Return the sync of charts with the same timing and music."""
    try:
        music = music_file(song, charts[0])
    except FileError as error:
        return SongSync(sync_of(None, 0.0, reason=error.message))
    try:
        heard = hear(music)
    except FileError as error:
        return SongSync(sync_of(None, 0.0, reason=f"its music {music.name} {error.message}"))
    except EncoderError as error:
        reason = f"its music cannot be decoded: {error}"
        return SongSync(sync_of(None, 0.0, reason=reason), damage=reason)
    found = judge(charts[0].timing, charts, heard.onsets)
    if isinstance(found, Sync):
        return SongSync(found, heard=heard)
    return SongSync(found.sync, found, heard=heard)


# The music that was decoded last, by path, size and time of its file.
_heard: OrderedDict[tuple[Path, int, int], Heard] = OrderedDict()


def hear(music: Path) -> Heard:
    """Return onsets, silence and clipping of a music file; FileError or EncoderError if it cannot be decoded."""
    try:
        status = music.stat()
    except OSError as error:
        raise FileError(music, f"cannot be read: {error.strerror}") from None
    key = music, status.st_size, status.st_mtime_ns
    if key not in _heard:
        head: AudioHead = read_head(music)
        sound: Sound = decode_music(music, head)
        if len(sound.samples) < sound.rate:
            raise FileError(music, "holds less than a second of music")
        _heard[key] = Heard(onsets(sound), sound.silence, sound.clipped)
        while len(_heard) > _KEPT:
            _heard.popitem(last=False)
    return _heard[key]
