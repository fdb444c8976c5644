"""No code is taken from a place that somebody else can write, or that came with the songs: attacks that ran, each."""

from __future__ import annotations

import hashlib
import json
import os
import pickle
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from dancetutor_cli.run import trust
from dancetutor_cli.run.trust import (
    exclude,
    fault_of,
    read_file,
    temporary_folder,
    use_folder,
    users_folder,
    write_file,
)

posix = pytest.mark.skipif(os.name == "nt", reason="Windows gives each user folders of their own")
as_root = pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="only root gives files away")
SOMEBODY = 12345
PROGRAM = """
import sys
from pathlib import Path
from dancetutor_cli.run.kernels import stored_code
stored_code.PACKAGE = Path(__file__) / "read only"
import some_kernels
print(some_kernels.double(4))
"""
MODULE = """
from dancetutor_cli.run.kernels.compiling import njit

@njit(cache=True)
def double(x):
    return 2 * x
"""


class Payload:
    """What writes a file as soon as it is unpickled."""

    def __init__(self, mark: Path) -> None:
        self._mark = mark

    def __reduce__(self) -> tuple[object, ...]:
        return Path.touch, (self._mark,)


class Victim:
    """A process with one kernel, in a folder of its own, and places that others may have filled."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.mark = folder, folder / "was here"
        (folder / "program").mkdir()
        (folder / "program" / "some_kernels.py").write_text(MODULE, "utf-8")
        (folder / "program" / "run.py").write_text(PROGRAM, "utf-8")
        (folder / "home").mkdir(mode=0o700)

    def run(self, cwd: Path | None = None, **environment: str) -> str:
        """What the process says after its result, which is right in any case."""
        kept = {name: value for name, value in os.environ.items() if not name.startswith(("NUMBA_", "XDG_", "TMP"))}
        own = {"HOME": str(self.folder / "home"), "PYTHONPATH": str(Path(trust.PACKAGE).parent)}
        command = [sys.executable, self.folder / "program" / "run.py"]
        ran = subprocess.run(
            command, cwd=cwd or self.folder, env=kept | own | environment, capture_output=True, text=True, timeout=60
        )
        assert (ran.returncode, ran.stdout) == (0, "8\n"), ran.stderr
        return ran.stderr

    def poison(self, place: Path) -> None:
        """Let all that is kept below a place do something else, with checksums that are right."""
        files = [path for path in place.rglob("*") if path.is_file()]
        assert files
        for path in files:
            body = path.read_bytes()[32:96] + pickle.dumps(Payload(self.mark))
            path.write_bytes(hashlib.sha256(body).digest() + body)


@pytest.fixture
def victim(tmp_path: Path) -> Victim:
    """A process that can be attacked."""
    return Victim(tmp_path)


def test_what_this_user_has_kept_is_loaded(victim: Victim) -> None:
    """So the attacks below are real: the same files in the user's own place do run."""
    victim.run()
    victim.poison(victim.folder / "home" / ".cache")
    victim.run()
    assert victim.mark.exists()


@pytest.mark.parametrize("variable", ["XDG_CACHE_HOME", "NUMBA_CACHE_DIR"])
def test_a_relative_place_is_ignored(victim: Victim, variable: str) -> None:
    place = victim.folder / "cache"
    victim.run(**{variable: str(place)})
    victim.poison(place)
    victim.run(**{variable: "cache"})
    assert not victim.mark.exists()


@posix
@pytest.mark.parametrize("variable", ["XDG_CACHE_HOME", "NUMBA_CACHE_DIR"])
@pytest.mark.parametrize("mode", [0o777, 0o757, 0o775, 0o1777])
@pytest.mark.parametrize("above", [False, True])
def test_a_place_that_others_can_write_is_not_used(victim: Victim, variable: str, mode: int, above: bool) -> None:
    shared = victim.folder / "shared"
    place = shared / "cache"
    victim.run(**{variable: str(place)})
    victim.poison(place)
    (shared if above else place).chmod(mode)
    victim.run(**{variable: str(place)})
    is_as_tmp = mode == 0o1777 and (above or variable == "XDG_CACHE_HOME")  # where folders of one's own are safe
    is_own_group = mode == 0o775 and trust._is_private_group(shared.stat().st_gid)  # Debian's, of this user alone
    assert victim.mark.exists() == (is_as_tmp or is_own_group)


@posix
@as_root
@pytest.mark.parametrize("variable", ["XDG_CACHE_HOME", "NUMBA_CACHE_DIR"])
def test_files_of_another_user_are_not_loaded(victim: Victim, variable: str) -> None:
    place = victim.folder / "shared" / "cache"
    victim.run(**{variable: str(place)})
    files = [path for path in place.rglob("*") if path.is_file()]
    for theirs in ([place], [place.parent], [files[0].parent], files):
        victim.poison(place)
        for path in theirs:
            os.chown(path, SOMEBODY, SOMEBODY)
        victim.run(**{variable: str(place)})
        assert not victim.mark.exists(), theirs
        for path in theirs:
            os.chown(path, 0, 0)


@posix
@pytest.mark.parametrize("is_file", [True, False])
def test_a_file_that_others_can_write_or_a_link_is_not_loaded(victim: Victim, is_file: bool) -> None:
    place = victim.folder / "cache"
    victim.run(NUMBA_CACHE_DIR=str(place))
    victim.poison(place)
    for path in [path for path in place.rglob("*") if path.is_file()]:
        if is_file:
            path.chmod(0o666)
        else:
            path.symlink_to(path.rename(path.with_suffix(".moved")))
    victim.run(NUMBA_CACHE_DIR=str(place))
    assert not victim.mark.exists()


@posix
def test_a_pipe_in_the_place_of_a_kernel_does_not_hang(victim: Victim) -> None:
    place = victim.folder / "cache"
    victim.run(NUMBA_CACHE_DIR=str(place))
    for path in [path for path in place.rglob("*") if path.is_file()]:
        path.unlink()
        os.mkfifo(path)
    victim.run(NUMBA_CACHE_DIR=str(place))
    assert all(path.is_file() or path.is_dir() for path in place.rglob("*"))  # and was replaced by what is right


@pytest.mark.parametrize(
    "said", ["cpu_name: bdver4", "cpu_features: +avx512f\nopt: 0", "- a list", "opt: [many", "a: b: c"]
)
def test_nothing_in_the_current_folder_steers_compiling(victim: Victim, said: str) -> None:
    place, here = victim.folder / "cache", victim.folder / "pack"
    here.mkdir()
    (here / ".numba_config.yaml").write_text(said, "utf-8")
    assert victim.run(here, NUMBA_CACHE_DIR=str(place)) == ""
    victim.poison(place)
    victim.run(NUMBA_CACHE_DIR=str(place))
    assert victim.mark.exists()  # it was kept for the same processor as without that file


def test_only_one_module_imports_numba() -> None:
    """So that it reads nothing of the current folder, and no start waits for it that needs none of it."""
    package = Path(trust.PACKAGE)
    modules = {
        path.relative_to(package).as_posix()
        for path in package.rglob("*.py")
        if re.search(r"^ *(import|from) numba\b", path.read_text("utf-8"), re.M)
    }
    assert modules == {"run/kernels/compiling.py"}


def test_nothing_is_kept_in_the_current_folder_for_want_of_another(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for here in (".", str(tmp_path)):
        monkeypatch.setenv("TMPDIR", here)
        folder = temporary_folder("some-kernels")
        assert folder is None or not folder.is_relative_to(tmp_path)
    assert not list(tmp_path.iterdir())


def test_nothing_is_taken_from_a_tree_that_is_read(tmp_path: Path) -> None:
    song = tmp_path / "pack" / "song" / "x.sm"
    song.parent.mkdir(parents=True)
    song.touch()
    inside, beside = tmp_path / "pack" / ".cache", tmp_path / "cache"
    assert fault_of(inside) == fault_of(beside) == use_folder(beside) == ""
    exclude(song)
    assert fault_of(inside) == "" and "charts are read" in fault_of(song.parent / "cache")
    exclude(tmp_path / "pack")
    assert "charts are read" in use_folder(inside) and not inside.exists()
    assert fault_of(beside) == ""
    (tmp_path / "link").symlink_to(tmp_path / "pack")
    assert "charts are read" in fault_of(tmp_path / "link" / "cache")
    exclude(Path(os.path.realpath("/")))
    assert fault_of(trust.PACKAGE) == ""  # whose code runs anyway
    assert fault_of(beside)


@pytest.mark.parametrize("command", ["analyze", "annotate", "animate", "render", "page", "retarget"])
def test_every_command_that_reads_charts_says_so(command: str, tmp_path: Path) -> None:
    song = tmp_path / "nothing.sm"
    program = (
        "import os, sys; from dancetutor_cli.__main__ import main; from dancetutor_cli.run import trust\n"
        "try: main(sys.argv[1:])\nexcept SystemExit: print(os.environ.get(trust.TREES))"
    )
    ran = subprocess.run(
        [sys.executable, "-c", program, command, song, *(("-o", "x.npz") if command == "retarget" else ())],
        capture_output=True,
        text=True,
    )
    assert json.loads(ran.stdout.splitlines()[-1]) == [str(tmp_path)], ran


@posix
@pytest.mark.parametrize("variable", ["DANCETUTOR_CACHE", "NUMBA_CACHE_DIR"])
@pytest.mark.parametrize("fault", ["can be written by others", "charts are read", "absolute path"])
def test_a_place_that_is_not_used_is_one_line(variable: str, fault: str, tmp_path: Path) -> None:
    song, place = tmp_path / "song" / "x.sm", tmp_path / "cache"
    song.parent.mkdir()
    place.mkdir()
    song.write_bytes(b"#TITLE:T;\n#BPMS:0=120;\n#NOTES:dance-single::Hard:9::\n1000\n0001\n;\n")
    if fault.startswith("can"):
        place.chmod(0o777)
    elif fault.startswith("charts"):
        place = song.parent / "cache"
    environment = {name: value for name, value in os.environ.items() if name != "DANCETUTOR_KERNELS"}
    environment |= {"DANCETUTOR_CACHE": str(tmp_path / "results")} | {
        variable: "cache" if fault.startswith("absolute") else str(place)
    }
    command = [sys.executable, "-P" if sys.version_info >= (3, 11) else "-s", "-m", "dancetutor_cli", "analyze", song]
    ran = subprocess.run([*command, "--exit-zero"], cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert ran.returncode == 0
    (line,) = ran.stderr.splitlines()
    assert line.startswith("note: ") and fault in line
    assert not place.exists() or not list(place.iterdir())


def test_a_relative_home_or_cache_is_no_place(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("XDG_CACHE_HOME", "LOCALAPPDATA", "HOME", "USERPROFILE"):
        monkeypatch.setenv(name, "here")
    assert users_folder("dancetutor") is None


@posix
@pytest.mark.parametrize("make", [os.mkfifo, Path.mkdir, lambda path: path.symlink_to("/dev/zero"), None])
def test_only_ordinary_files_are_read(tmp_path: Path, make: Callable[[Path], object] | None) -> None:
    path = tmp_path / "x"
    if make is not None:
        make(path)
    with pytest.raises(OSError):
        read_file(path)
    if make is not Path.mkdir:
        write_file(path, b"new")
        assert read_file(path) == b"new" and path.stat().st_mode & 0o777 == 0o600


@posix
def test_devices_are_no_files() -> None:
    with pytest.raises(OSError):
        read_file(Path("/dev/zero"))


@posix
def test_a_group_of_the_user_alone_may_write(monkeypatch: pytest.MonkeyPatch) -> None:
    """As Debian makes one for each user; but not for root, whose files everybody runs."""
    import grp
    import pwd
    from types import SimpleNamespace as Entry

    user = Entry(pw_uid=7, pw_gid=7, pw_name="ann")
    groups = {7: Entry(gr_name="ann", gr_mem=[]), 8: Entry(gr_name="all", gr_mem=["ann", "bob"])}
    monkeypatch.setattr(os, "geteuid", lambda: 7)
    monkeypatch.setattr(pwd, "getpwuid", lambda _: user)
    monkeypatch.setattr(grp, "getgrgid", groups.__getitem__)

    def fault(uid: int, gid: int, mode: int) -> str:
        return trust._fault(os.stat_result((mode, 0, 0, 1, uid, gid, 0, 0, 0, 0)))

    assert fault(7, 7, 0o40775) == "" and fault(7, 9, 0o40755) == "" and fault(0, 0, 0o40755) == ""
    for others in ((7, 8, 0o40775), (7, 9, 0o40775), (7, 7, 0o40777), (8, 7, 0o40755), (0, 0, 0o40775)):
        assert fault(*others), others
    groups[7].gr_mem.append("bob")
    assert fault(7, 7, 0o40775)
