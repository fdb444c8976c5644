"""DT602: the bias changes over the song."""

from __future__ import annotations

from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import SyncRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.findings import Sync
    from dancetutor_cli.lint.subject import FileSubject


class SyncDrift(SyncRule):
    """The music moves against the beats from the first to the last third: the tempo is a little off.

    `most`: ms of drift that are no finding. Needs `--sync`; `--plot FILE.svg` shows where.

    Bad: #BPMS:0=140.01; for music of 140 BPM: 9 ms in two minutes. Better: #BPMS:0=140;
    """

    code = "DT602"
    name = "sync-drift"
    tag = "BPMS"

    def message(self, sync: Sync, subject: FileSubject) -> str | None:
        """How much, and by how much a steady tempo would be off."""
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
        return f": the tempo is {right:.3f} BPM rather than {bpm:.3f}"
