"""Archives are unpacked alike on Pythons with tarfile's filters and on those without; nothing leaves the folder."""

from __future__ import annotations

import io
import os
import tarfile
from pathlib import Path

import pytest
from module_file import tool

HARMFUL = {
    "above": ("../out.txt", tarfile.REGTYPE, ""),
    "absolute": ("/out.txt", tarfile.REGTYPE, ""),
    "link": ("link", tarfile.SYMTYPE, "/etc"),
    "hard link": ("link", tarfile.LNKTYPE, "../out.txt"),
    "pipe": ("pipe", tarfile.FIFOTYPE, ""),
}


def archive(name: str, kind: bytes = tarfile.REGTYPE, target: str = "") -> tarfile.TarFile:
    """An archive of one member, a program with the set-uid bit if it is a file."""
    data = io.BytesIO()
    with tarfile.open(fileobj=data, mode="w") as out:
        info = tarfile.TarInfo(name)
        info.type, info.linkname, info.mode, info.size = kind, target, 0o4775, 3 if kind == tarfile.REGTYPE else 0
        out.addfile(info, io.BytesIO(b"abc"))
    data.seek(0)
    return tarfile.open(fileobj=data)


def test_without_filters_the_files_come_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(tarfile, "data_filter", raising=False)  # as in Python 3.11.2
    extractall = tarfile.TarFile.extractall

    def old(self: tarfile.TarFile, path: Path, members: object = None, *, numeric_owner: bool = False) -> None:
        extractall(self, path, members, numeric_owner=numeric_owner)  # type: ignore[arg-type]

    monkeypatch.setattr(tarfile.TarFile, "extractall", old)
    tool("unpacking").unpack(archive("songs/a.sm"), tmp_path)
    assert (tmp_path / "songs" / "a.sm").read_bytes() == b"abc"
    assert os.name == "nt" or (tmp_path / "songs" / "a.sm").stat().st_mode & 0o7777 == 0o755


@pytest.mark.parametrize("case", HARMFUL)
def test_nothing_leaves_the_folder(tmp_path: Path, case: str) -> None:
    inside = tmp_path / "inside"
    inside.mkdir()
    with pytest.raises(tarfile.TarError):
        tool("unpacking").unpack_without_filter(archive(*HARMFUL[case]), inside)
    assert list(tmp_path.rglob("*")) == [inside]
