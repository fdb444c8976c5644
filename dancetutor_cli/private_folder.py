"""A folder that only this user can write, for what a later run believes: found or made, or refused with a reason.

Whoever can rename a folder above it can put another in its place; so those above it count, up to the root.
"""

from __future__ import annotations

import os
import stat
import sys
from pathlib import Path

VARIABLES = ("DANCETUTOR_CACHE", "XDG_CACHE_HOME")


def private_folder(name: str, foreign: tuple[Path, ...] = ()) -> tuple[Path | None, str]:
    """The folder of that name in the user's cache, made if it is not there; or None, and why.

    foreign : folders with what others may have written, such as a pack; a cache that a variable puts there is not used
    """
    base, variable = _cache()
    if base is None:
        return None, "this user has no home folder"
    if not base.is_absolute():
        return None, f"{base} ({variable}) is a relative path"
    where = f"{base} ({variable})" if variable else str(base)
    try:
        base = base.resolve()
        if variable and any(base.is_relative_to(one.resolve()) for one in foreign):
            return None, f"{where} lies inside the folder that is read or written"
        folder = base / name
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        fault = writable_by_others(folder)
    except OSError as error:
        return None, f"{where}: {error.strerror or error}"
    return (None, fault) if fault else (folder, "")


def _cache() -> tuple[Path | None, str]:
    """The user's cache of this program, and the variable that names it, if one does."""
    named, platform = (os.environ.get(one) for one in VARIABLES)
    if named:
        return Path(named), VARIABLES[0]
    try:
        if sys.platform == "win32":
            return Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local") / "dancetutor", ""
        if sys.platform == "darwin":
            return Path.home() / "Library" / "Caches" / "dancetutor", ""
        if platform and Path(platform).is_absolute():  # a relative one is to be ignored, says the XDG specification
            return Path(platform) / "dancetutor", VARIABLES[1]
        return Path.home() / ".cache" / "dancetutor", ""
    except RuntimeError:
        return None, ""


def writable_by_others(folder: Path) -> str:
    """Who else could put something at the place of an absolute folder without links in it, in words; "" for nobody.

    A folder that others may write is no danger below one that they cannot enter. In a folder with the sticky bit,
    such as /tmp, everybody may make files, and only their owner may rename them.
    """
    if not hasattr(os, "getuid"):  # Windows, where a user's folders are the user's
        return ""
    closed = False
    for one in (*reversed(folder.parents), folder):
        status = one.lstat()
        if not stat.S_ISDIR(status.st_mode):
            return f"{one} is no folder"
        if status.st_uid not in (0, os.getuid()):
            return f"{one} belongs to somebody else"
        open_to_others = status.st_mode & 0o022 and not (status.st_mode & stat.S_ISVTX and one != folder)
        if open_to_others and not closed:
            return f"{one} can be written by others"
        closed = closed or not status.st_mode & 0o011
    return ""
