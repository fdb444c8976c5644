"""DT604: a pack with songs of both kinds of sync."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import PackRule, PackSong

if TYPE_CHECKING:
    from dancetutor_cli.chart.pack_files import PackIni

_KINDS = {"null": "null", "itg": "ITG"}
_LISTED = 5


class MixedSync(PackRule):
    """Some songs of the pack are at the beats (null) and some 9 ms after them (ITG): no setting suits both.

    `least`: songs of the rarer kind that are a finding. Needs `--sync`.

    Bad: ten songs at 0 ms and two at 9 ms. Better: all at one of them, and #OFFSET of the others changed.
    """

    code = "DT604"
    name = "mixed-sync"

    def check_pack(self, songs: Sequence[PackSong], ini: PackIni | None) -> str | None:
        """The songs of the rarer kind."""
        kinds = {kind: [one.folder for one in songs if one.sync.kind == kind] for kind in _KINDS}
        rarer, usual = sorted(kinds, key=lambda kind: len(kinds[kind]))
        if len(kinds[rarer]) < self.options["least"]:
            return None
        more = f" and {len(kinds[rarer]) - _LISTED} more" if len(kinds[rarer]) > _LISTED else ""
        listed = f"{', '.join(kinds[rarer][:_LISTED])}{more}"
        many, few = (_count(len(kinds[kind]), _KINDS[kind]) for kind in (usual, rarer))
        return f"of the songs {many}, and {few}: {listed}"


def _count(count: int, kind: str) -> str:
    return f"{count} {'is' if count == 1 else 'are'} {kind}"
