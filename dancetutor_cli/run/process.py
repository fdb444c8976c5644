"""Settings of a process at its start, its standard streams, and the handling of Ctrl-C."""

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

# Settings at the start of a process: fewer garbage collections, and no threads of numpy.
#
# Imports and kernels make many objects that live until the end.

_SELDOM = 200_000  # new objects between two garbage collections; Python's default of 700 costs 0.1 s during imports


def reduce_garbage_collection() -> None:
    """Make collections of cyclic garbage rare."""
    gc.set_threshold(_SELDOM, 10, 10)


def forbid_blas_threads() -> None:
    """Keep numpy from making a thread for each core, which only products of large matrices would use.

    Call this before numpy is imported; worker processes inherit it. A number that the user has set is kept.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


def freeze_objects() -> None:
    """Exclude all present objects from garbage collections."""
    if not gc.get_freeze_count():  # frozen cycles are never freed, so this happens only once
        gc.freeze()


def skip_last_collection() -> None:
    """Skip the garbage collection at the end of the process: numba's objects make it take longer than a chart."""
    gc.freeze()


# Standard output and standard error, with their names in errors and escapes for characters that they cannot encode.

OUTPUT = "standard output"
_FULL = (errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC), errno.EFBIG)


class _NamedOutput(io.FileIO):
    """Standard output whose errors have its name as the file name."""

    def write(self, data: Any) -> int:
        try:
            return super().write(data)
        except OSError as error:
            raise OSError(error.errno, error.strerror, OUTPUT) from None


class _Errors(io.FileIO):
    """Standard error that ignores failures such as a full disk, so that the run continues to its exit status."""

    def write(self, data: Any) -> int:
        try:
            return super().write(data)
        except BrokenPipeError:
            raise
        except OSError:
            return len(data)


def open_streams() -> bool:
    """Prepare both streams; return False if standard output is closed."""
    if sys.stderr is None:  # closed, as by `2>&-`
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: PTH123, SIM115
    if sys.stdout is None:
        return False
    sys.stdout, sys.stderr = _reopen_as(_NamedOutput, sys.stdout), _reopen_as(_Errors, sys.stderr)
    for stream in (sys.stdout, sys.stderr):
        _escape_missing_letters(stream)
    return True


def _reopen_as(kind: type[io.FileIO], stream: Any) -> Any:
    """Return the stream on a file of this kind, in which other people's text cannot be a command for CI.

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
    """Write characters that the stream's encoding does not have as \\uXXXX, so that a title cannot end the run."""
    encoding = str(getattr(stream, "encoding", None) or "utf-8").lower().replace("_", "-")
    if encoding not in ("utf-8", "utf8", "utf-16") and isinstance(stream, io.TextIOWrapper):
        stream.reconfigure(errors="backslashreplace")


def drop_output() -> None:
    """Discard further standard output, because flushing its buffer at the end of the process would fail again."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def os_error_message(error: OSError) -> str:
    """Return a system error in one line, with its file and, for a full disk, what to do."""
    where = f"{error.filename}: " if error.filename else ""
    line = f"{where}{error.strerror or error}"
    if error.filename == OUTPUT and error.errno in _FULL:
        line += "; what was written is cut short: make room, or send it elsewhere"
    return line


# If Python cannot raise an exception for a Ctrl-C, it is sent again a moment later, and its errors are not reported.
#
# The compiler swallows exceptions that are raised in its callbacks into Python, and then fails with another error.

_AGAIN = 0.05  # seconds


class _Hook:
    """The hook for exceptions that Python cannot raise. interrupted : whether one of them was a Ctrl-C"""

    def __init__(self) -> None:
        self.interrupted = False

    def __call__(self, unraisable: sys.UnraisableHookArgs) -> None:
        """Repeat a lost Ctrl-C; other errors come from cleaning up after an interrupt, and are ignored."""
        if not issubclass(unraisable.exc_type, KeyboardInterrupt):
            if os.environ.get("DANCETUTOR_TRACEBACK"):
                sys.__unraisablehook__(unraisable)
            return
        self.interrupted = True
        again = threading.Timer(_AGAIN, _interrupt)
        again.daemon = True
        again.start()


def _interrupt() -> None:
    """Interrupt the main thread as the keyboard does; on Windows, code that waits notices it only after the wait."""
    if hasattr(signal, "pthread_kill"):
        signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGINT)
    else:  # Windows
        _thread.interrupt_main()


def catch_lost_interrupts() -> None:
    """Install the hook that repeats each lost Ctrl-C in this process."""
    sys.unraisablehook = _Hook()


def end_at_once(status: int) -> NoReturn:
    """End the process without freeing its objects, because freeing objects that a Ctrl-C left half made may crash."""
    with suppress(KeyboardInterrupt):  # a lost Ctrl-C may come again
        atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, KeyboardInterrupt):
            stream.flush()
    os._exit(status)


def is_interruption(error: BaseException) -> bool:
    """Whether an exception comes from a Ctrl-C, even in a callback or at the return of a kernel."""
    hook = sys.unraisablehook
    return (isinstance(hook, _Hook) and hook.interrupted) or _came_of_one(error)


def _came_of_one(error: BaseException | None) -> bool:
    """Whether the cause of an error is a KeyboardInterrupt, such as of a kernel's result with an exception set."""
    if isinstance(error, SystemError):
        return _came_of_one(error.__cause__) or _came_of_one(error.__context__)
    if isinstance(error, DancetutorError):
        return _came_of_one(error.__cause__)
    return isinstance(error, KeyboardInterrupt)
