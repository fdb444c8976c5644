"""Start of the program: runs the command line and turns every expected failure into one line and an exit status."""

from __future__ import annotations

import os
import sys

TYPE_CHECKING = False  # as `typing` has it, whose import takes as long as all that comes before the first `try`
if TYPE_CHECKING:
    from collections.abc import Sequence


def main(arguments: Sequence[str] | None = None) -> None:
    """Run `dancetutor`; ends the process with an exit status of the README's table.

    arguments : None: those of the command line, of a process that does nothing else
    """
    try:
        from dancetutor_cli.run.process import open_streams

        if not open_streams():
            _say("standard output is closed; send it to a file, or to /dev/null")
            sys.exit(2)
        if os.environ.get("_DANCETUTOR_COMPLETE", "").startswith("powershell"):
            from dancetutor_cli.commands import completion  # noqa: F401 (makes this shell known)
        status = _run(arguments)
    except KeyboardInterrupt:  # while the first modules are imported, or as the last words are said
        _say("interrupted")
        status = 130
    if status == 130 and arguments is None:
        from dancetutor_cli.run.process import end_at_once

        end_at_once(status)
    sys.exit(status)


def _run(arguments: Sequence[str] | None) -> int:
    """The exit status."""
    from dancetutor_cli.run.process import forbid_blas_threads, reduce_garbage_collection, skip_last_collection

    reduce_garbage_collection()
    forbid_blas_threads()
    from dancetutor_cli.commands import cli
    from dancetutor_cli.run.process import catch_lost_interrupts

    catch_lost_interrupts()
    output = sys.stdout
    try:
        status = cli.main(arguments, prog_name="dancetutor", standalone_mode=False)
        sys.stdout.flush()
    except SystemExit:
        if sys.stdout is output:
            raise
        status = _reader_gone()  # click has seen it, put another stream here and made 1 of it, which means findings
    except BaseException as error:
        status = _report_end(error)
    skip_last_collection()
    return status if isinstance(status, int) else 0


def _report_end(error: BaseException) -> int:
    """Say in one line what ended the run; the exit status."""
    import click

    from dancetutor_cli.run.errors import DancetutorError
    from dancetutor_cli.run.process import OUTPUT, drop_output, is_interruption, os_error_message

    if isinstance(error, click.exceptions.Exit):
        return error.exit_code
    if isinstance(error, click.exceptions.Abort) or is_interruption(error):
        _say("interrupted")
        return 130
    if isinstance(error, click.ClickException):
        from dancetutor_cli.commands.arguments import usage_message

        _say(usage_message(error))
    elif isinstance(error, DancetutorError):
        _say(str(error))
        return error.exit_status
    elif isinstance(error, BrokenPipeError):
        return _reader_gone()
    elif isinstance(error, MemoryError):
        _say("out of memory")
    elif isinstance(error, OSError):
        _say(os_error_message(error))
        if error.filename == OUTPUT:
            drop_output()
    elif os.environ.get("DANCETUTOR_TRACEBACK"):
        raise error
    else:
        # A mistake of the program, not of the user: still one line, with the way to the whole story.
        name = type(error).__name__
        _say(f"internal error: {name}: {error}; set DANCETUTOR_TRACEBACK=1 to see where, and report it")
    return 2


def _reader_gone() -> int:
    """The reader of a pipe has gone (`| head`); nobody is left to report to. A shell makes this of SIGPIPE."""
    from dancetutor_cli.run.process import drop_output

    drop_output()
    return 141


def _say(message: str) -> None:
    one_line = " ".join(message.splitlines())
    sys.stderr.write(f"dancetutor: {one_line}\n")


if __name__ == "__main__":
    main()
