"""Unpacking the project's own archives, also on Pythons whose tarfile has no filters (before 3.11.4; Debian 12)."""

from __future__ import annotations

import tarfile
from pathlib import Path


def unpack(archive: tarfile.TarFile, folder: Path) -> None:
    """Write an archive's files and folders below `folder`. Raises tarfile.TarError for what is not."""
    if hasattr(tarfile, "data_filter"):
        archive.extractall(folder, filter="data")
        return
    unpack_without_filter(archive, folder)


def unpack_without_filter(archive: tarfile.TarFile, folder: Path) -> None:
    """The same by a check of our own: plain files and folders only, with names below `folder`, without set-uid bits."""
    top = folder.resolve()
    members = archive.getmembers()
    for member in members:
        if not (member.isfile() or member.isdir()):
            raise tarfile.TarError(f"{member.name} is neither a file nor a folder")
        if not (top / member.name).resolve().is_relative_to(top):
            raise tarfile.TarError(f"{member.name} would lie outside {folder}")
        member.mode = 0o755 if member.isdir() or member.mode & 0o100 else 0o644
        member.uid = member.gid = 0
        member.uname = member.gname = ""
    archive.extractall(folder, members, numeric_owner=False)
