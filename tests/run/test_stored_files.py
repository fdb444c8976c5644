"""Stored files: whole or not at all, and removed when old or too many."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from dancetutor_cli.run.stored_files import DAY, StoredFiles


def aged(path: Path, days: float) -> None:
    then = path.stat().st_mtime - days * DAY
    os.utime(path, (then, then))


def test_a_file_comes_back_and_a_missing_or_large_one_does_not(tmp_path: Path) -> None:
    files = StoredFiles(tmp_path / "store", longest=DAY)
    files.write("ab/c", b"one")
    files.write("ab/c", b"two")
    assert files.read("ab/c", 3) == b"two"
    assert files.read("ab/c", 2) is None and files.read("ab/d", 3) is None and files.read("ab", 3) is None
    assert [path.name for path in (tmp_path / "store" / "ab").iterdir()] == ["c"]


def test_a_full_disk_keeps_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    files = StoredFiles(tmp_path)
    files.write("a", b"old")

    def full(self: Path, target: Path) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", full)
    files.write("a", b"new")
    assert files.read("a", 9) == b"old" and [path.name for path in tmp_path.iterdir()] == ["a"]


def test_what_was_read_lately_stays(tmp_path: Path) -> None:
    files = StoredFiles(tmp_path, longest=10 * DAY)
    for name in ("read", "unread", "young"):
        files.write(f"x/{name}", b"1")
    for name in ("read", "unread"):
        aged(tmp_path / "x" / name, 9)
    assert files.read("x/read", 9) == b"1"
    for name in ("read", "unread"):
        aged(tmp_path / "x" / name, 2)
    files.prune()
    assert {path.name for path in (tmp_path / "x").iterdir()} == {"read", "young"}


def test_the_oldest_of_too_many_bytes_go(tmp_path: Path) -> None:
    files = StoredFiles(tmp_path, largest=25)
    for days, name in ((3, "a"), (2, "b"), (1, "c")):
        files.write(name, b"0" * 10)
        aged(tmp_path / name, days)
    files.prune()
    assert {path.name for path in tmp_path.iterdir()} == {"b", "c"}
    assert files.read("b", 99) is not None  # now the youngest
    files.write("d", b"0" * 10)
    files.prune()
    assert {path.name for path in tmp_path.iterdir()} == {"b", "d"}


@pytest.mark.skipif(os.name == "nt", reason="links need rights there")
def test_links_are_removed_and_never_followed(tmp_path: Path) -> None:
    outside = tmp_path / "outside"
    outside.mkdir()
    (outside / "mine").write_bytes(b"0" * 100)
    aged(outside / "mine", 100)
    store = tmp_path / "store"
    store.mkdir()
    (store / "folder").symlink_to(outside)
    StoredFiles(store, longest=DAY, largest=1).prune()
    assert (outside / "mine").exists()
    (store / "file").symlink_to(outside / "mine")
    StoredFiles(store).write("file", b"new")
    assert (outside / "mine").read_bytes() == b"0" * 100 and not (store / "file").is_symlink()
