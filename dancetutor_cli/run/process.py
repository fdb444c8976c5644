"""A process and its surroundings: what it decides as it starts, standard streams, a Ctrl-C at a bad moment."""

from __future__ import annotations

import _thread
import atexit
import errno
import gc
import io
import os
import signal
import sys
import threading
from contextlib import suppress
from typing import Any, NoReturn

from dancetutor_cli.run.errors import DancetutorError
from dancetutor_cli.run.foreign_text import GuardedText

# What a process of the program decides as it starts: when to look for garbage, and that numpy makes no threads.
#
# Imports and kernels make many objects that stay to its end.

_SELDOM = 200_000  # new objects between two looks for garbage; Python's own 700 cost a tenth of a second of imports


def reduce_garbage_collection() -> None:
    """Look for garbage in cycles seldom."""
    gc.set_threshold(_SELDOM, 10, 10)


def forbid_blas_threads() -> None:
    """numpy makes a thread for each core as it is imported, for products of large matrices, of which there are none.

    To be called before that; holds for worker processes, too. A user who has said another number gets it.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


def freeze_objects() -> None:
    """What has been imported and made so far stays to the end: it is not looked through for garbage again."""
    if not gc.get_freeze_count():  # what is frozen is never freed in cycles, so that happens once
        gc.freeze()


def skip_last_collection() -> None:
    """The process ends: no last look through every object that numba has made, which takes longer than a chart."""
    gc.freeze()


# Standard output and standard error as this program needs them: their names in errors, letters that they lack.

OUTPUT = "standard output"
_FULL = (errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC), errno.EFBIG)


class _NamedOutput(io.FileIO):
    """Standard output, whose errors say that it is it: Python's own name no file."""

    def write(self, data: Any) -> int:
        try:
            return super().write(data)
        except OSError as error:
            raise OSError(error.errno, error.strerror, OUTPUT) from None


class _Errors(io.FileIO):
    """Standard error: where nothing can be said (a full disk), the run goes on, and its exit status says."""

    def write(self, data: Any) -> int:
        try:
            return super().write(data)
        except BrokenPipeError:
            raise
        except OSError:
            return len(data)


def open_streams() -> bool:
    """Make both ready; False if standard output is closed."""
    if sys.stderr is None:  # closed, as by `2>&-`
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: PTH123, SIM115
    if sys.stdout is None:
        return False
    sys.stdout, sys.stderr = _reopen_as(_NamedOutput, sys.stdout), _reopen_as(_Errors, sys.stderr)
    for stream in (sys.stdout, sys.stderr):
        _escape_missing_letters(stream)
    return True


def _reopen_as(kind: type[io.FileIO], stream: Any) -> Any:
    """The same stream on a file of this kind, in which no text of others is a command for CI.

    A console of Windows, which is never full, stays as it is.
    """
    if not isinstance(stream, io.TextIOWrapper):
        return stream
    has_buffer = type(stream.buffer) is io.BufferedWriter
    if type(stream.buffer.raw if has_buffer else stream.buffer) is not io.FileIO:
        return stream
    raw = kind(stream.fileno(), "wb", closefd=False)
    return GuardedText(
        io.BufferedWriter(raw) if has_buffer else raw, stream.encoding, stream.errors,
        line_buffering=stream.line_buffering, write_through=stream.write_through,
    )  # fmt: skip


def _escape_missing_letters(stream: object) -> None:
    """On a console that is not UTF-8, letters that it lacks come as \\uXXXX: a title must not end the run."""
    encoding = str(getattr(stream, "encoding", None) or "utf-8").lower().replace("_", "-")
    if encoding not in ("utf-8", "utf8", "utf-16") and isinstance(stream, io.TextIOWrapper):
        stream.reconfigure(errors="backslashreplace")


def drop_output() -> None:
    """Nothing more goes to standard output: what is left in its buffer would fail once more as the process ends."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def os_error_message(error: OSError) -> str:
    """The error of the system in one line: where, what, and what to do about a full disk."""
    where = f"{error.filename}: " if error.filename else ""
    line = f"{where}{error.strerror or error}"
    if error.filename == OUTPUT and error.errno in _FULL:
        line += "; what was written is cut short: make room, or send it elsewhere"
    return line


# A Ctrl-C that falls where Python cannot raise it: it comes again a moment later, and what it broke is no fault.
#
# The compiler calls back into Python, and what is raised there is swallowed; then it misses what the callback should
# have left, and says so in its own words.

_AGAIN = 0.05  # seconds


class _Hook:
    """What Python calls with an exception that it cannot raise. interrupted : whether one of them was a Ctrl-C"""

    def __init__(self) -> None:
        self.interrupted = False

    def __call__(self, unraisable: sys.UnraisableHookArgs) -> None:
        """Other errors here come from clearing away what an interrupt left half made; they change no result."""
        if not issubclass(unraisable.exc_type, KeyboardInterrupt):
            if os.environ.get("DANCETUTOR_TRACEBACK"):
                sys.__unraisablehook__(unraisable)
            return
        self.interrupted = True
        again = threading.Timer(_AGAIN, _interrupt)
        again.daemon = True
        again.start()


def _interrupt() -> None:
    """As the keyboard does; where only Python is notified, code that waits notices it when the wait is over."""
    if hasattr(signal, "pthread_kill"):
        signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGINT)
    else:  # Windows
        _thread.interrupt_main()


def catch_lost_interrupts() -> None:
    """From now on no Ctrl-C is lost in this process."""
    sys.unraisablehook = _Hook()


def end_at_once(status: int) -> NoReturn:
    """End the process, but leave its memory as it is: to take apart what a Ctrl-C left half made may crash."""
    with suppress(KeyboardInterrupt):  # one that was lost comes again
        atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, KeyboardInterrupt):
            stream.flush()
    os._exit(status)


def is_interruption(error: BaseException) -> bool:
    """Whether an exception comes from Ctrl-C, which may fall into a callback, or into a kernel as it comes back."""
    hook = sys.unraisablehook
    return (isinstance(hook, _Hook) and hook.interrupted) or _came_of_one(error)


def _came_of_one(error: BaseException | None) -> bool:
    """Whether Python reports a fault that came of an interrupt: a kernel gave a result with an exception set."""
    if isinstance(error, SystemError):
        return _came_of_one(error.__cause__) or _came_of_one(error.__context__)
    if isinstance(error, DancetutorError):
        return _came_of_one(error.__cause__)
    return isinstance(error, KeyboardInterrupt)
