"""Find the feet of a stepchart, lint it, annotate it, bake and render a dancer who plays it."""

__version__ = "0.2.0.dev0"

import sys


def _excepthook(kind: type[BaseException], error: BaseException, trace: object) -> None:
    """Write one line for a Ctrl-C that comes before `__main__.main` can catch it, as for any later one."""
    if issubclass(kind, KeyboardInterrupt):
        sys.stderr.write("dancetutor: interrupted\n")
    else:
        sys.__excepthook__(kind, error, trace)  # type: ignore[arg-type]


# Only as a program, "dancetutor" or "python -m dancetutor_cli", and before anything else is imported.
_NAMES = ("dancetutor", __name__)
if any(one.replace("\\", "/").rpartition("/")[2].partition(".")[0] in _NAMES for one in sys.orig_argv):
    sys.excepthook = _excepthook
