"""What is wrong with the syncs of a pack's songs together: rules that need all of its results."""

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

_FEWEST = 2  # songs of a pack
_STEADY = 6.0  # ms of drift; with more a song is neither null nor ITG


class PackSyncs:
    """Takes results as they come. A song that lies there as .sm and .ssc counts once, as .ssc."""

    def __init__(self) -> None:
        self._songs: dict[Path, dict[str, tuple[str, Sync]]] = {}
        self._names: dict[Path, str] = {}  # of the folders, as their files were named

    def add(self, result: FileResult) -> None:
        """Take note of a file whose sync is sure and steady."""
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
        """The folders of packs, those with songs enough to be one."""
        return (folder for folder in sorted(self._songs) if len(self._songs[folder]) >= _FEWEST)

    def result(self, folder: Path, settings: Settings) -> FileResult | None:
        """The findings for the pack of a folder, as a result of that folder; None if there are none."""
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
