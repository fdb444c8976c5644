"""Versions of a pack to compare with: another path, a revision of git, or the files that `analyze` last read."""

from __future__ import annotations

import hashlib
import os
import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from dancetutor_cli.chart.selection import find_files, is_chart_name, is_excluded
from dancetutor_cli.run.errors import FileError, UsageError
from dancetutor_cli.run.reading import CHART_LIMIT, read_bytes
from dancetutor_cli.run.stored_files import DAY, StoredFiles
from dancetutor_cli.run.trust import kept_folder, programs

LAST = "last"  # the value of --compare that means the last run


@dataclass(frozen=True, slots=True)
class StoredFile:
    """One file of a version. read : returns its bytes, or FileError; digest : `hash_of` of the bytes, "" if unknown"""

    read: Callable[[], bytes]
    digest: str = ""
    hash_of: Callable[[bytes], str] = str

    def is_same(self, data: bytes) -> bool:
        """Whether the file has these bytes; it is read only if its digest is not known."""
        return self.hash_of(data) == self.digest if self.digest else self.read() == data


@dataclass(frozen=True, slots=True)
class Snapshot:
    """The chart files of a version, by their paths below the compared folder.

    label : name of the version for people; new : the message for a file that is not in the version
    """

    label: str
    files: Mapping[str, StoredFile]
    new: str = "is new"


def snapshot_of(other: str, path: Path, exclude: Sequence[str] = ()) -> Snapshot:
    """Return the version of `path` that `other` names: a file or folder, "last", or a revision; UsageError if none.

    exclude : see `find_files`
    """
    there = Path(other)
    if os.path.lexists(there):
        if there.is_dir() != path.is_dir():
            raise UsageError("--compare takes two files or two folders")
        return snapshot_of_path(there, exclude, None if path.is_dir() else path.name)
    return snapshot_of_last_run(path, exclude) if other == LAST else snapshot_of_revision(other, path, exclude)


def snapshot_of_path(path: Path, exclude: Sequence[str] = (), name: str | None = None) -> Snapshot:
    """Return the chart files that a path has now. name : the name by which a single file is compared, None: its own"""
    if not path.is_dir():
        return Snapshot(str(path), {name or path.name: StoredFile(partial(read_bytes, path, CHART_LIMIT))})
    files = {Path(os.path.relpath(file, path)).as_posix(): file for file in find_files([path], exclude)}
    return Snapshot(
        str(path), {name: StoredFile(partial(read_bytes, file, CHART_LIMIT)) for name, file in files.items()}
    )


# A revision of the git repository that a path lies in.
#
# A pack may contain a repository with a configuration of its own. No command of it is run: git only lists and reads
# objects. Hooks, monitors and transports are off, because a partial clone would fetch objects with a command of its
# choice. A bare repository inside the pack is not used. git decides if it trusts the repository (safe.directory).

_GIT = "git.exe" if os.name == "nt" else "git"
_OFF = (
    "-c", "core.fsmonitor=", "-c", f"core.hooksPath={os.devnull}", "-c", "safe.bareRepository=explicit",
    "-c", "protocol.allow=never", "-c", "core.sshCommand=false", "-c", "credential.helper=", "--no-pager",
)  # fmt: skip
_ENVIRONMENT = {
    "GIT_ALLOW_PROTOCOL": "none", "GIT_NO_LAZY_FETCH": "1", "GIT_OPTIONAL_LOCKS": "0", "GIT_TERMINAL_PROMPT": "0",
    "GIT_NO_REPLACE_OBJECTS": "1", "LC_ALL": "C",
}  # fmt: skip
_OF_ANOTHER = (  # variables that git sets for its hooks, maybe for another repository
    "GIT_DIR", "GIT_WORK_TREE", "GIT_COMMON_DIR", "GIT_PREFIX", "GIT_INDEX_FILE", "GIT_OBJECT_DIRECTORY",
    "GIT_ALTERNATE_OBJECT_DIRECTORIES", "GIT_NAMESPACE",
)  # fmt: skip
_PATIENCE = 60.0  # seconds; the longest that git may run
_HASHES = {40: hashlib.sha1, 64: hashlib.sha256}  # letters of an object's name -> hash that makes the name


def snapshot_of_revision(revision: str, path: Path, exclude: Sequence[str] = ()) -> Snapshot:
    """Return the chart files of a path at a revision of git, such as HEAD~1.

    UsageError, one line, if git is not installed or the revision does not exist.
    """
    folder = path.absolute() if path.is_dir() else path.absolute().parent
    commit = _git(folder, revision, "rev-parse", "--verify", "--quiet", "--end-of-options", f"{revision}^{{commit}}")
    name = commit.decode("ascii", "replace").strip()
    listed = _git(folder, revision, "ls-tree", "-r", "-z", "-l", name, "--", "." if path.is_dir() else path.name)
    files = dict(_blobs(folder, revision, listed, path.is_dir(), exclude))
    if not files:
        raise UsageError(f"--compare {revision}: git has no chart file of {path} there")
    return Snapshot(revision, files)


def _blobs(
    folder: Path, revision: str, listed: bytes, searched: bool, exclude: Sequence[str]
) -> Iterator[tuple[str, StoredFile]]:
    """Yield the chart files in the output of `git ls-tree -l -z`, with entries "mode type object size<tab>path"."""
    for entry in listed.split(b"\0"):
        head, tab, name = entry.partition(b"\t")
        fields = head.decode("ascii", "replace").split()
        path = os.fsdecode(name)
        if not tab or len(fields) != 4 or fields[0] not in ("100644", "100755"):  # not links or submodules
            continue
        if searched and (not is_chart_name(path.rpartition("/")[2]) or is_excluded(path, exclude)):
            continue
        digest, size = fields[2], int(fields[3]) if fields[3].isdigit() else 0  # "BAD" if a partial clone lacks it
        make = _HASHES.get(len(digest), hashlib.sha1)

        def read(digest: str = digest, size: int = size, path: str = path) -> bytes:
            if size > CHART_LIMIT:
                raise FileError(path, f"has {size} bytes at {revision}; it is not read")
            try:
                return _git(folder, revision, "cat-file", "blob", digest)
            except UsageError as error:
                raise FileError(path, str(error)) from None

        def hash_of(data: bytes, make: Callable[[bytes], hashlib._Hash] = make) -> str:
            return make(b"blob %d\0" % len(data) + data).hexdigest()

        yield path, StoredFile(read, digest, hash_of)


def _git(folder: Path, revision: str, *words: str) -> bytes:
    """Return the output of a git command; UsageError with one line if it fails."""
    import subprocess  # here because most runs do not need it

    program = next(programs(_GIT, os.environ.get("PATH", os.defpath)), None)
    message = f"--compare {revision}: there is no such file or folder"
    if program is None:
        raise UsageError(f"{message}; for a revision install git")
    environment = {name: value for name, value in os.environ.items() if name not in _OF_ANOTHER} | _ENVIRONMENT
    try:
        done = subprocess.run(
            [program, *_OFF, *words], cwd=folder, env=environment, stdin=subprocess.DEVNULL, capture_output=True,
            timeout=_PATIENCE, check=False,
        )  # fmt: skip
    except (OSError, ValueError, subprocess.TimeoutExpired) as error:
        raise UsageError(f"--compare {revision}: git failed: {error}") from None
    if done.returncode == 0:
        return done.stdout
    why = done.stderr.decode("utf-8", "replace")
    if "not a git repository" in why:
        raise UsageError(f"{message}, and {folder} is not in a git repository")
    if "dubious ownership" in why:
        raise UsageError(
            f"--compare {revision}: {folder} is in a repository that belongs to another user; git does not read it; "
            "if you trust it, add it to git's safe.directory"
        )
    if words[0] == "rev-parse":
        raise UsageError(f"{message}, nor a revision of that name; for the last run write {LAST}")
    raise UsageError(f"--compare {revision}: git: {' '.join(why.split())[:200] or f'status {done.returncode}'}")


# The chart files as the last run of `analyze` read them, compressed in the user's cache.
#
# A file of the store has a head, the SHA-256 of the chart file, the length of its path, the path, and its bytes.

_HEAD = b"dancetutor chart 1\n"
_DIGEST = 32
_KEPT = 180 * DAY  # a file that is not analyzed again for so long is removed
_LONGEST = 1 << 16  # most bytes of a path


class ChartStore:
    """A folder of chart files as they were. A file that cannot be written or read is not kept, without an error."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._files = StoredFiles(folder, longest=_KEPT)

    def keep(self, path: Path) -> None:
        """Keep a file as it is now; nothing is written if the store has it already."""
        with suppress(OSError, FileError):
            data = read_bytes(path, CHART_LIMIT)
            head, name = _HEAD + hashlib.sha256(data).digest(), os.fsencode(path.absolute())
            place = self._folder / hashlib.sha256(name).hexdigest()
            if _head_of(place)[: len(head)] != head:
                self._files.write(place.name, head + len(name).to_bytes(4, "big") + name + zlib.compress(data, 3))

    def files(self) -> Iterator[tuple[Path, StoredFile]]:
        """Yield every kept file with its absolute path."""
        for place in sorted(self._folder.glob("*")):
            head = _head_of(place)
            start = len(_HEAD) + _DIGEST
            end = start + 4 + int.from_bytes(head[start : start + 4], "big")
            if head.startswith(_HEAD) and start + 4 < end <= len(head):
                digest = head[len(_HEAD) : start].hex()
                path = Path(os.fsdecode(head[start + 4 : end]))
                yield path, StoredFile(partial(_unpacked, place, end), digest, _sha256)

    def prune(self) -> None:
        """Remove files that have not been analyzed for a long time."""
        self._files.prune()


def open_store() -> ChartStore | None:
    """Return the store in the user's cache; None if nothing can be kept."""
    folder = kept_folder("charts")
    return None if folder is None else ChartStore(folder)


def snapshot_of_last_run(path: Path, exclude: Sequence[str] = ()) -> Snapshot:
    """Return the chart files of a path as the last run of `analyze` read them; UsageError if there are none."""
    store, files = open_store(), dict[str, StoredFile]()
    root = path.absolute()
    for file, stored in store.files() if store is not None else ():
        if path.is_dir() and file.is_relative_to(root) and not is_excluded(file.relative_to(root).as_posix(), exclude):
            files[file.relative_to(root).as_posix()] = stored
        elif file == root:
            files[path.name] = stored
    if not files:
        raise UsageError(
            f"--compare {LAST}: no earlier run of analyze on {path} is stored; `dancetutor analyze {path}` stores one"
        )
    return Snapshot("the last run", files, "is new, or was not analyzed before")


def _sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def _head_of(place: Path) -> bytes:
    """Return the first bytes of a kept file, up to the longest path; empty if it cannot be read."""
    try:
        with place.open("rb") as file:
            return file.read(len(_HEAD) + _DIGEST + 4 + _LONGEST)
    except OSError:
        return b""


def _unpacked(place: Path, start: int) -> bytes:
    """Return the bytes of a kept chart file; FileError if it is damaged."""
    opened = zlib.decompressobj()
    try:
        data = opened.decompress(read_bytes(place, 2 * CHART_LIMIT)[start:], CHART_LIMIT)
    except zlib.error:
        raise FileError(place, "is damaged") from None
    if not opened.eof:
        raise FileError(place, "is cut off, or too large")
    return data
