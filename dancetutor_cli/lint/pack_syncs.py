"""The rules about the syncs of all songs of a pack, which need the results of all its files."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from dancetutor_cli.chart.pack_files import pack_folder, read_pack_ini
from dancetutor_cli.lint.results import FileResult
from dancetutor_cli.lint.rule import PackRule, PackSong, all_rules

if TYPE_CHECKING:
    from dancetutor_cli.lint.findings import Finding, Sync
    from dancetutor_cli.lint.rule_settings import Settings

_FEWEST = 2  # the least number of songs in a pack
_STEADY = 6.0  # ms; a song with more drift is neither null nor ITG


class PackSyncs:
    """Collects the syncs of songs, pack by pack. A song with a .sm and a .ssc counts once, by its .ssc."""

    def __init__(self) -> None:
        self._songs: dict[Path, dict[str, tuple[str, Sync]]] = {}
        self._names: dict[Path, str] = {}  # names of the folders, relative if their files were named so

    def add(self, result: FileResult) -> None:
        """Add a file, if its sync is sure and steady."""
        sync = result.sync
        if sync is None or not sync.is_sure or abs(sync.drift_ms or 0.0) > _STEADY:
            return
        path = Path(result.path)
        folder = pack_folder(path.absolute())
        self._names.setdefault(folder, os.fspath(folder) if path.is_absolute() else os.path.relpath(folder))
        songs = self._songs.setdefault(folder, {})
        key = os.fspath(path.absolute().with_suffix(""))
        if key not in songs or path.suffix.lower() == ".ssc":
            songs[key] = path.absolute().parent.name, sync

    @property
    def folders(self) -> Iterator[Path]:
        """The folders with enough songs for a pack."""
        return (folder for folder in sorted(self._songs) if len(self._songs[folder]) >= _FEWEST)

    def result(self, folder: Path, settings: Settings) -> FileResult | None:
        """Return the findings for the pack in a folder, as the result of that folder; None if it has none."""
        songs = [PackSong(*song) for _, song in sorted(self._songs[folder].items())]
        ini = read_pack_ini(folder)
        findings: list[Finding] = []
        for code, options in settings.for_file(folder).items():
            kind = all_rules()[code]
            if issubclass(kind, PackRule):
                rule = kind(options)
                if message := rule.check_pack(songs, ini):
                    findings.append(rule.finding(message, {}))
        if not findings:
            return None
        return FileResult(self._names[folder], folder.name, "", None, (), tuple(findings), ())
