"""DT603: the chart is half a beat off."""

from __future__ import annotations

from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import SyncRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.findings import Sync
    from dancetutor_cli.lint.subject import FileSubject


class BeatOff(SyncRule):
    """The music is more than a quarter beat off: on-beats of the chart are off-beats of the music.

    Needs `--sync`.

    Bad: #OFFSET:0.250; at 120 BPM with music that is at the beats. Better: #OFFSET:0.000;
    """

    code = "DT603"
    name = "beat-off"

    def message(self, sync: Sync, subject: FileSubject) -> str | None:
        """By how much."""
        if sync.bias_ms is None or not sync.beat_off:
            return None
        side = "after" if sync.bias_ms > 0 else "before"
        change = f"change #OFFSET by {-sync.bias_ms / 1000:+.3f}, or as much the other way"
        return f"the music is {abs(sync.bias_ms):.1f} ms {side} the beats, about half a beat; {change}"
