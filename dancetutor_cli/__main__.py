"""Start of the program: runs the command line and turns every expected failure into one line and an exit status."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Sequence


def main(arguments: Sequence[str] | None = None) -> None:
    """Run `dancetutor`; ends the process with an exit status of the README's table."""
    if sys.stderr is None:  # closed, as by `2>&-`
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: PTH123, SIM115
    if sys.stdout is None:
        _say("standard output is closed; send it to a file, or to /dev/null")
        sys.exit(2)
    for stream in (sys.stdout, sys.stderr):
        _say_what_it_can(stream)
    try:
        if os.environ.get("_DANCETUTOR_COMPLETE", "").startswith("powershell"):
            from dancetutor_cli.commands import completion  # noqa: F401 (makes this shell known)
        _run(arguments)
    except KeyboardInterrupt:  # while the first modules are imported
        _say("interrupted")
        sys.exit(130)


def _run(arguments: Sequence[str] | None) -> None:
    from dancetutor_cli.startup import collect_seldom, leave_garbage, without_threads

    collect_seldom()
    without_threads()
    import click

    from dancetutor_cli.commands import cli
    from dancetutor_cli.errors import DancetutorError

    sys.unraisablehook = _interrupt_again
    output = sys.stdout
    try:
        status = cli.main(arguments, prog_name="dancetutor", standalone_mode=False)
        sys.stdout.flush()
    except click.exceptions.Exit as stop:
        status = stop.exit_code
    except click.ClickException as error:
        error.show()
        status = 2
    except (KeyboardInterrupt, click.exceptions.Abort):
        _say("interrupted")
        status = 130
    except DancetutorError as error:
        _say(str(error))
        status = error.exit_status
    except BrokenPipeError:
        status = _reader_gone()
    except SystemExit:
        if sys.stdout is output:
            raise
        status = _reader_gone()  # click has seen it, put another stream here and made 1 of it, which means findings
    except MemoryError:
        _say("out of memory")
        status = 2
    except OSError as error:
        where = f"{error.filename}: " if error.filename else ""
        _say(f"{where}{error.strerror or error}")
        status = 2
    except Exception as error:
        if _is_interruption(error):
            _say("interrupted")
            sys.exit(130)
        # A mistake of the program, not of the user: still one line, with the way to the whole story.
        if os.environ.get("DANCETUTOR_TRACEBACK"):
            raise
        _say(f"internal error: {type(error).__name__}: {error}; set DANCETUTOR_TRACEBACK=1 to see where, and report it")
        status = 2
    leave_garbage()
    sys.exit(status if isinstance(status, int) else 0)


def _reader_gone() -> int:
    """The reader of a pipe has gone (`| head`); nobody is left to be told. A shell makes this of SIGPIPE."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return 141


def _is_interruption(error: BaseException | None) -> bool:
    """Whether a Ctrl-C fell into a kernel as it came back; Python then tells of a fault that came of it."""
    if not isinstance(error, SystemError):
        return isinstance(error, KeyboardInterrupt)
    return _is_interruption(error.__cause__) or _is_interruption(error.__context__)


def _say_what_it_can(stream: object) -> None:
    """On a console that is not UTF-8, letters that it lacks come as \\uXXXX: a title must not end the run."""
    encoding = str(getattr(stream, "encoding", None) or "utf-8").lower().replace("_", "-")
    if encoding not in ("utf-8", "utf8", "utf-16") and isinstance(stream, io.TextIOWrapper):
        stream.reconfigure(errors="backslashreplace")


def _interrupt_again(unraisable: sys.UnraisableHookArgs) -> None:
    """A Ctrl-C that falls into a callback of the compiler is swallowed there: it comes again a moment later.

    Other errors here come from clearing away what an interrupt left half made; they change no result.
    """
    if not issubclass(unraisable.exc_type, KeyboardInterrupt):
        if os.environ.get("DANCETUTOR_TRACEBACK"):
            sys.__unraisablehook__(unraisable)
        return
    import _thread
    import threading

    again = threading.Timer(0.05, _thread.interrupt_main)
    again.daemon = True
    again.start()


def _say(message: str) -> None:
    one_line = " ".join(message.splitlines())
    sys.stderr.write(f"dancetutor: {one_line}\n")


if __name__ == "__main__":
    main()
