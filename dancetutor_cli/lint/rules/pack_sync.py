"""DT605: Pack.ini says another sync than the songs have."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import PackRule, PackSong

if TYPE_CHECKING:
    from dancetutor_cli.chart.pack_files import PackIni

_SHARE = 0.6  # of the songs that are null or ITG
_KINDS = {"NULL": "null", "ITG": "itg"}


class PackSync(PackRule):
    """`SyncOffset` of the pack's Pack.ini says NULL and most songs are ITG, or the other way round.

    ITGmania shifts the songs by what it says. `least`: sure songs that decide. Needs `--sync`.

    Bad: SyncOffset=ITG with songs at 0 ms. Better: SyncOffset=NULL
    """

    code = "DT605"
    name = "pack-sync"

    def check_pack(self, songs: Sequence[PackSong], ini: PackIni | None) -> str | None:
        """What it says and what the songs are."""
        said = "" if ini is None else ini.sync.upper()
        decided = [one for one in songs if one.sync.kind in _KINDS.values()]
        others = [one for one in decided if one.sync.kind != _KINDS.get(said)]
        if said not in _KINDS or len(decided) < self.options["least"] or len(others) < _SHARE * len(decided):
            return None
        (is_said,) = (name for name in _KINDS if name != said)
        return f"Pack.ini says SyncOffset={said}, but {len(others)} of {len(decided)} songs are {is_said}"
