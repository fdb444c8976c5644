"""A Ctrl-C that falls where Python cannot raise it is still one."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from dancetutor_cli.__main__ import main
from dancetutor_cli.commands import cli
from dancetutor_cli.run.errors import DancetutorError
from dancetutor_cli.run.pool import Task, open_workers
from dancetutor_cli.run.process import catch_lost_interrupts

EARLY = "import sys, dancetutor_cli\nraise KeyboardInterrupt"
KERNEL = """from dancetutor_cli.run.kernels.compiling import njit


@njit(cache=True)
def twice(x):
    return 2 * x
"""
# Ctrl-C as LLVM hands over the machine code; what numba does without it is asked here, too
PROGRAM = """
import os, signal, sys
from numba.core.codegen import JITCodeLibrary
from dancetutor_cli.__main__ import main
from dancetutor_cli.commands import cli

signal.signal(signal.SIGINT, signal.default_int_handler)
handed_over = JITCodeLibrary._object_compiled_hook.__func__


def hook(kind, module, code):
    if any("twice" in one.name for one in module.functions):
        os.kill(os.getpid(), signal.SIGINT)
    handed_over(kind, module, code)


JITCodeLibrary._object_compiled_hook = classmethod(hook)


def run(*_, **__):
    from twice import twice
    {how}


cli.main = run
main([])
"""
DIRECTLY = "print(twice(3))"
AS_WORK = """from dancetutor_cli.run.pool import Task, open_workers
    workers = open_workers(1, print)
    workers.submit(Task(1, lambda: twice(3)))
    print(*workers.results())"""


@pytest.mark.skipif(os.name == "nt", reason="sends SIGINT to one process, which Windows cannot")
@pytest.mark.parametrize("how", [DIRECTLY, AS_WORK], ids=["directly", "as work"])
def test_ctrl_c_as_llvm_hands_machine_code_over(how: str, tmp_path: Path) -> None:
    (tmp_path / "twice.py").write_text(KERNEL, encoding="utf-8")
    path = os.pathsep.join([str(Path(__file__).parents[1]), str(tmp_path)])
    environment = {**os.environ, "PYTHONPATH": path, "NUMBA_CACHE_DIR": str(tmp_path / "kernels")}
    command = [sys.executable, "-c", PROGRAM.format(how=how)]
    ran = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=120)
    assert (ran.returncode, ran.stdout, ran.stderr) == (130, "", "dancetutor: interrupted\n")


@pytest.mark.skipif(os.name == "nt", reason="ends by a signal, the POSIX way")
@pytest.mark.parametrize(("name", "said"), [("dancetutor", True), ("dancetutor_cli.py", True), ("other.py", False)])
def test_ctrl_c_before_the_program_can_catch_it(name: str, said: bool, tmp_path: Path) -> None:
    """While the first of its modules is imported. A program that only uses the package has Python's own words."""
    (tmp_path / name).write_text(EARLY)
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[1])}
    command = [sys.executable, "-P", str(tmp_path / name)]
    ran = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=120)
    assert ran.returncode == -signal.SIGINT and ("Traceback" in ran.stderr) != said
    assert (ran.stderr == "dancetutor: interrupted\n") == said


ENDING = """
import atexit, os, sys
from dancetutor_cli.__main__ import main
from dancetutor_cli.commands import cli


class Broken:
    def __del__(self, write=os.write):
        write(2, b"taken apart")


def run(*_, **__):
    print("some of it")
    raise KeyboardInterrupt


atexit.register(print, "cleared away")
sys.broken, cli.main = Broken(), run
main()
"""


def test_what_a_ctrl_c_has_left_half_made_is_not_taken_apart() -> None:
    """Once in a hundred runs that was a crash. What the end of a process clears away is."""
    ran = subprocess.run([sys.executable, "-c", ENDING], capture_output=True, text=True, timeout=120)
    assert (ran.returncode, ran.stdout) == (130, "some of it\ncleared away\n")
    assert ran.stderr == "dancetutor: interrupted\n"


def _faults() -> list[Exception]:
    """As Python tells of it: a result with an exception set; through several kernels several times."""
    cause, context, twice = (SystemError("f returned a result with an exception set") for _ in range(3))
    cause.__cause__, context.__context__ = KeyboardInterrupt(), KeyboardInterrupt()
    twice.__cause__ = cause
    door = DancetutorError("the kernel f raised an exception")
    door.__cause__ = twice
    return [cause, context, twice, door]


@pytest.mark.parametrize("fault", _faults(), ids=["cause", "context", "twice", "door"])
def test_ctrl_c_within_a_kernel(fault: Exception, interrupted_by: Callable[[Exception], tuple[object, str]]) -> None:
    assert interrupted_by(fault) == (130, "dancetutor: interrupted\n")
    workers = open_workers(1)
    workers.submit(Task(1, _fail, (fault,)))
    with pytest.raises(KeyboardInterrupt):
        list(workers.results())


def test_another_fault_is_not(interrupted_by: Callable[[Exception], tuple[object, str]]) -> None:
    fault = SystemError("a result with an exception set")
    fault.__cause__ = ValueError("x")
    status, said = interrupted_by(fault)
    assert status == 2
    assert "internal error: SystemError" in said


@pytest.mark.skipif(os.name == "nt", reason="there it comes when the wait is over")
def test_a_lost_ctrl_c_comes_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "unraisablehook", sys.unraisablehook)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        catch_lost_interrupts()
        with pytest.raises(KeyboardInterrupt):
            _Lost().lose()
    finally:
        signal.signal(signal.SIGINT, before)


class _Lost:
    """Interrupted as it goes, where Python can raise nothing."""

    def lose(self) -> None:
        """Wait for what is lost meanwhile."""
        import threading

        class Dying:
            def __del__(self) -> None:
                raise KeyboardInterrupt

        Dying()
        threading.Event().wait(60)


def _fail(error: Exception) -> None:
    raise error


@pytest.fixture
def interrupted_by(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Callable[[Exception], tuple[object, str]]:
    """Exit status and what is said where the command line raises this."""

    def ended(fault: Exception) -> tuple[object, str]:
        monkeypatch.delenv("DANCETUTOR_TRACEBACK", raising=False)
        monkeypatch.setattr(sys, "unraisablehook", sys.unraisablehook)
        monkeypatch.setattr(cli, "main", lambda *_, **__: _fail(fault))
        with pytest.raises(SystemExit) as stop:
            main([])
        return stop.value.code, capsys.readouterr().err

    return ended
