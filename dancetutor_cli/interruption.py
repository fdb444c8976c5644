"""A Ctrl-C that falls where Python cannot raise it: it comes again a moment later, and what it broke is no fault.

The compiler calls back into Python, and what is raised there is swallowed; then it misses what the callback should have
left, and says so in its own words.
"""

from __future__ import annotations

import _thread
import atexit
import os
import signal
import sys
import threading
from contextlib import suppress
from typing import NoReturn

from dancetutor_cli.errors import DancetutorError

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
    """As the keyboard does; where only Python is told, who waits for something hears of it when that has come."""
    if hasattr(signal, "pthread_kill"):
        signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGINT)
    else:  # Windows
        _thread.interrupt_main()


def hear_again() -> None:
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
    """Whether a Ctrl-C lies behind what was raised: it fell into a callback, or into a kernel as it came back."""
    hook = sys.unraisablehook
    return (isinstance(hook, _Hook) and hook.interrupted) or _came_of_one(error)


def _came_of_one(error: BaseException | None) -> bool:
    """Whether Python tells of a fault that came of an interrupt: a kernel gave a result with an exception set."""
    if isinstance(error, SystemError):
        return _came_of_one(error.__cause__) or _came_of_one(error.__context__)
    if isinstance(error, DancetutorError):
        return _came_of_one(error.__cause__)
    return isinstance(error, KeyboardInterrupt)
