"""The atomic writer: what stays, what is refused, and that a kill at any moment leaves the old or the new file."""

from __future__ import annotations

import contextlib
import os
import random
import shutil
import stat
import subprocess
import sys
import time
from pathlib import Path
from typing import BinaryIO

import pytest

from dancetutor_cli.run import files
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.files import remove_leftovers, temporary_name, write_atomic

POSIX = pytest.mark.skipif(os.name == "nt", reason="POSIX modes, links and locks")
ROOT = os.name != "nt" and os.geteuid() == 0


def names(folder: Path) -> list[str]:
    return sorted(p.name for p in folder.iterdir())


def test_replaces_and_creates(tmp_path: Path) -> None:
    old = tmp_path / "a.sm"
    old.write_bytes(b"old")
    write_atomic(old, b"new")
    write_atomic(tmp_path / "b.sm", lambda file: file.write(b"fresh"))
    assert old.read_bytes() == b"new"
    assert (tmp_path / "b.sm").read_bytes() == b"fresh"
    assert names(tmp_path) == ["a.sm", "b.sm"]


@POSIX
@pytest.mark.parametrize("mode", [0o600, 0o644, 0o755, 0o666])
def test_keeps_the_mode(tmp_path: Path, mode: int) -> None:
    path = tmp_path / "a.sm"
    path.write_bytes(b"old")
    path.chmod(mode)
    write_atomic(path, b"new")
    assert stat.S_IMODE(path.stat().st_mode) == mode


@POSIX
def test_a_new_file_has_the_mode_that_open_gives(tmp_path: Path) -> None:
    (tmp_path / "plain").write_bytes(b"")
    write_atomic(tmp_path / "ours", b"")
    assert (tmp_path / "ours").stat().st_mode == (tmp_path / "plain").stat().st_mode


@pytest.mark.skipif(not ROOT, reason="only root may give files away")
def test_keeps_the_owner(tmp_path: Path) -> None:
    path = tmp_path / "a.sm"
    path.write_bytes(b"old")
    os.chown(path, 1234, 4321)
    path.chmod(0o640)
    write_atomic(path, b"new")
    status = path.stat()
    assert (status.st_uid, status.st_gid, stat.S_IMODE(status.st_mode)) == (1234, 4321, 0o640)


@POSIX
def test_refuses_what_belongs_to_another_user(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A process without the right to give files away must not take the file over by its rename."""
    path = tmp_path / "a.sm"
    path.write_bytes(b"old")
    mine = os.fstat

    def other(descriptor: int) -> os.stat_result:
        status = mine(descriptor)
        return os.stat_result((*status[:4], status.st_uid + 1, *status[5:]))

    def refused(*_: object) -> None:
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(files.os.path, "samestat", lambda a, b: a.st_ino == b.st_ino)
    monkeypatch.setattr(files.os, "fstat", other)
    monkeypatch.setattr(files.os, "chown", refused)
    with pytest.raises(FileError, match="another"):
        write_atomic(path, b"new")
    assert path.read_bytes() == b"old"
    assert names(tmp_path) == ["a.sm"]


@POSIX
def test_writes_through_a_link_and_keeps_it(tmp_path: Path) -> None:
    (tmp_path / "pack").mkdir()
    target = tmp_path / "pack" / "song.sm"
    target.write_bytes(b"old")
    link = tmp_path / "link.sm"
    link.symlink_to(Path("pack") / "song.sm")
    write_atomic(link, b"new", expect=b"old")
    assert link.is_symlink()
    assert target.read_bytes() == b"new"
    assert names(tmp_path) == ["link.sm", "pack"]
    assert names(target.parent) == ["song.sm"]


@POSIX
@pytest.mark.parametrize("aim", ["nowhere.sm", "circle.sm"])
def test_a_link_to_nothing_is_refused(tmp_path: Path, aim: str) -> None:
    link = tmp_path / "circle.sm"
    link.symlink_to(aim)
    with pytest.raises(FileError, match="link"):
        write_atomic(link, b"new")
    assert names(tmp_path) == ["circle.sm"]


def test_read_only_files_are_refused_even_for_root(tmp_path: Path) -> None:
    path = tmp_path / "a.sm"
    path.write_bytes(b"old")
    path.chmod(0o444)
    with pytest.raises(FileError, match="read-only"):
        write_atomic(path, b"new")
    assert path.read_bytes() == b"old"
    assert names(tmp_path) == ["a.sm"]


def test_folders_are_refused(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="is a folder"):
        write_atomic(tmp_path, b"new")
    with pytest.raises(FileError, match="does not exist"):
        write_atomic(tmp_path / "no" / "a.sm", b"new")


def test_an_error_while_writing_leaves_the_old_file(tmp_path: Path) -> None:
    path = tmp_path / "a.sm"
    path.write_bytes(b"old")

    def half(file: BinaryIO) -> None:
        file.write(b"ne")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_atomic(path, half)
    assert path.read_bytes() == b"old"
    assert names(tmp_path) == ["a.sm"]


def test_a_change_by_another_user_is_seen(tmp_path: Path) -> None:
    path = tmp_path / "a.sm"
    path.write_bytes(b"saved by the editor")
    with pytest.raises(files.ChangedError, match="changed"):
        write_atomic(path, b"new", expect=b"old")
    path.unlink()
    with pytest.raises(files.ChangedError, match="changed"):
        write_atomic(path, b"new", expect=b"old")
    assert names(tmp_path) == []


def test_a_long_name(tmp_path: Path) -> None:
    path = tmp_path / ("é" * 126 + ".sm")  # 255 bytes, the longest name there is
    write_atomic(path, b"new")
    write_atomic(path, b"newer")
    assert names(tmp_path) == [path.name]


def test_leftovers_are_removed(tmp_path: Path) -> None:
    path = tmp_path / "a.sm"
    path.write_bytes(b"old")
    temporary_name(path).write_bytes(b"half of the ne")
    temporary_name(tmp_path / "gone.sm").write_bytes(b"half")
    assert remove_leftovers(tmp_path) == 2
    assert remove_leftovers(tmp_path) == 0
    assert names(tmp_path) == ["a.sm"]
    temporary_name(path).write_bytes(b"half of the ne")
    write_atomic(path, b"new")
    assert path.read_bytes() == b"new"
    assert names(tmp_path) == ["a.sm"]


@POSIX
def test_a_file_that_a_living_process_writes_is_no_leftover(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.sm"
    path.write_bytes(b"old")
    monkeypatch.setattr(files, "PATIENCE", 0.1)

    def meanwhile(file: BinaryIO) -> None:
        assert remove_leftovers(tmp_path) == 0
        with pytest.raises(files.BusyError, match="another process"):
            write_atomic(path, b"other")
        file.write(b"new")

    write_atomic(path, meanwhile)
    assert path.read_bytes() == b"new"
    assert names(tmp_path) == ["a.sm"]


@POSIX
def test_without_locks_only_old_leftovers_are_removed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As on some network file systems."""

    def unsupported(*_: object) -> None:
        raise OSError(95, "Operation not supported")

    monkeypatch.setattr(files.fcntl, "flock", unsupported)
    monkeypatch.setattr(files, "PATIENCE", 0.1)
    path = tmp_path / "a.sm"
    write_atomic(path, b"new")
    temporary = temporary_name(path)
    temporary.write_bytes(b"perhaps somebody is writing this")
    assert remove_leftovers(tmp_path) == 0
    with pytest.raises(files.BusyError):
        write_atomic(path, b"newer")
    os.utime(temporary, (0, 0))
    write_atomic(path, b"newer")
    assert path.read_bytes() == b"newer"
    assert names(tmp_path) == ["a.sm"]


@POSIX
def test_a_planted_link_in_place_of_the_temporary_file_is_not_followed(tmp_path: Path) -> None:
    victim, path = tmp_path / "victim", tmp_path / "a.sm"
    victim.write_bytes(b"precious")
    path.write_bytes(b"old")
    temporary_name(path).symlink_to(victim)
    with contextlib.suppress(FileError):
        write_atomic(path, b"new")
    assert victim.read_bytes() == b"precious"
    assert path.read_bytes() in (b"old", b"new")


def test_full_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.sm"
    path.write_bytes(b"old")

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(files.os, "fsync", full)
    with pytest.raises(FileError, match="No space left on device; the old file is unchanged"):
        write_atomic(path, b"new")
    assert path.read_bytes() == b"old"
    assert names(tmp_path) == ["a.sm"]


def test_a_full_disk_has_no_old_file_to_speak_of(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(files.os, "fsync", full)
    with pytest.raises(FileError, match=r"cannot be written: No space left on device$"):
        write_atomic(tmp_path / "a.sm", b"new")
    assert names(tmp_path) == []


@pytest.fixture
def small_disk(tmp_path: Path) -> Path:
    if not ROOT or not shutil.which("mount"):
        pytest.skip("mounting a small disk needs root")
    disk = tmp_path / "disk"
    disk.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", disk], capture_output=True).returncode:
        pytest.skip("mounting is not allowed here")
    yield disk  # type: ignore[misc]
    subprocess.run(["umount", disk], check=True)


def test_a_really_full_disk(small_disk: Path) -> None:
    path = small_disk / "a.sm"
    path.write_bytes(b"o" * 40_000)
    with pytest.raises(FileError, match="No space left on device"):
        write_atomic(path, b"n" * 40_000)
    assert path.read_bytes() == b"o" * 40_000
    assert names(small_disk) == ["a.sm"]


CHILD = """
import sys
from pathlib import Path
from dancetutor_cli.run.files import write_atomic
path, contents = Path(sys.argv[1]), [bytes([c]) * 200_000 for c in b"ab"]
sys.stdout.write("ready"); sys.stdout.flush()
while True:
    for content in contents:
        write_atomic(path, content)
"""


@POSIX
def test_killed_at_any_moment_the_file_is_the_old_or_the_new_one(tmp_path: Path) -> None:
    """300 kills at random moments of a child that does nothing but write; it imports neither numpy nor numba."""
    path = tmp_path / "a.sm"
    path.write_bytes(b"a" * 200_000)
    whole = {b"a" * 200_000, b"b" * 200_000}
    dice, leftovers = random.Random(7), 0
    for _ in range(300):
        child = subprocess.Popen([sys.executable, "-S", "-E", "-c", BOOT + CHILD, path], stdout=subprocess.PIPE)
        assert child.stdout is not None
        assert child.stdout.read(5) == b"ready"
        time.sleep(dice.uniform(0, 0.004))
        child.kill()
        child.wait()
        child.stdout.close()
        assert path.read_bytes() in whole
        leftovers += temporary_name(path).exists()
        assert names(tmp_path) in (["a.sm"], [temporary_name(path).name, "a.sm"])
    assert leftovers > 10, "no kill hit the middle of a write: this test tests nothing"
    remove_leftovers(tmp_path)
    assert names(tmp_path) == ["a.sm"]


BOOT = f"import sys; sys.path.insert(0, {str(Path(files.__file__).parent.parent)!r})\n"

ADDER = """
import sys
from pathlib import Path
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.files import write_atomic
path, done = Path(sys.argv[1]), 0
while done < 50:
    old = path.read_bytes()
    try:
        write_atomic(path, old + b".", expect=old)
        done += 1
    except FileError as error:
        assert "changed" in str(error), error
"""


@POSIX
def test_two_processes_lose_nothing_of_each_other(tmp_path: Path) -> None:
    path = tmp_path / "a.sm"
    path.write_bytes(b"")
    command = [sys.executable, "-S", "-E", "-c", BOOT + ADDER, path]
    for child in [subprocess.Popen(command) for _ in range(3)]:
        assert child.wait(timeout=60) == 0
    assert len(path.read_bytes()) == 150
    assert names(tmp_path) == ["a.sm"]
