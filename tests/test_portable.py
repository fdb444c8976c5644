"""Windows and macOS, as far as they can be judged from here: nothing of POSIX without a way round, no text without its
encoding, no fork. What only those systems can show is not shown by this."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parent.parent / "dancetutor_cli"
FILES = sorted(PACKAGE.rglob("*.py"))
MODULES = {
    "crypt", "curses", "fcntl", "grp", "nis", "posix", "pty", "pwd", "readline", "resource", "spwd", "syslog",
    "termios", "tty",
}  # fmt: skip
ONLY_POSIX = {
    "os": {
        "O_CLOEXEC", "O_DIRECTORY", "O_NOFOLLOW", "O_NONBLOCK", "chown", "fchmod", "fchown", "fork", "forkpty",
        "getgid", "getpgid", "getuid", "geteuid", "getxattr", "killpg", "lchown", "listxattr", "mkfifo", "mknod",
        "nice", "sched_getaffinity", "sched_setaffinity", "setpgid", "setsid", "setxattr", "sysconf", "uname", "wait3",
        "wait4",
    },
    "signal": {
        "SIGALRM", "SIGCHLD", "SIGHUP", "SIGKILL", "SIGPIPE", "SIGQUIT", "SIGUSR1", "SIGUSR2", "alarm", "pthread_kill",
        "pthread_sigmask", "setitimer", "sigwait",
    },
    "time": {"tzset"},
    "select": {"epoll", "kqueue", "poll"},
}  # fmt: skip
DIGITS = {Path("feet/solver/compiled.py")}  # what it reads and writes are digits, the same in every encoding
CAUGHT = ("ImportError", "ModuleNotFoundError", "AttributeError")
ASKED = ("hasattr", "os.name", "sys.platform", "platform.system", "is None")


def parents_of(tree: ast.AST) -> dict[ast.AST, ast.AST]:
    return {child: node for node in ast.walk(tree) for child in ast.iter_child_nodes(node)}


def is_guarded(node: ast.AST, parents: dict[ast.AST, ast.AST]) -> bool:
    """Whether what is around a node catches that there is no such thing, or asks for the system before it."""
    inner = node
    while (outer := parents.get(inner)) is not None:
        if isinstance(outer, ast.Try) and inner in outer.body:
            if any(name in ast.unparse(h.type) for h in outer.handlers if h.type for name in CAUGHT):
                return True
        elif isinstance(outer, ast.With):
            said = " ".join(ast.unparse(item) for item in outer.items)
            if "suppress" in said and any(name in said for name in CAUGHT):
                return True
        elif isinstance(outer, ast.If | ast.IfExp):
            if any(word in ast.unparse(outer.test) for word in ASKED):
                return True
        elif isinstance(outer, ast.BoolOp):
            if any(word in ast.unparse(outer) for word in ASKED):
                return True
        elif isinstance(outer, ast.FunctionDef) and inner in outer.body:
            for before in outer.body[: outer.body.index(inner)]:  # if os.name == "nt": return
                leaves = isinstance(before, ast.If) and isinstance(before.body[-1], ast.Return | ast.Raise)
                if leaves and any(word in ast.unparse(before.test) for word in ASKED):
                    return True
        inner = outer
    return False


def unguarded(source: str) -> Iterator[str]:
    """What of POSIX alone a source uses without a way round."""
    tree = ast.parse(source)
    parents = parents_of(tree)
    for node in ast.walk(tree):
        names = []
        if isinstance(node, ast.Import):
            names = [one.name for one in node.names if one.name.partition(".")[0] in MODULES]
        elif isinstance(node, ast.ImportFrom):
            names = [node.module] if (node.module or "").partition(".")[0] in MODULES else []
            names += [
                f"{node.module}.{one.name}" for one in node.names if one.name in ONLY_POSIX.get(node.module or "", ())
            ]
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            names = [ast.unparse(node)] if node.attr in ONLY_POSIX.get(node.value.id, ()) else []
        yield from (f"{node.lineno}: {name}" for name in names if name and not is_guarded(node, parents))


def without_encoding(source: str) -> Iterator[str]:
    """Calls that read or write text in whatever encoding the machine happens to have."""
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.Call):
            continue
        given = {keyword.arg for keyword in node.keywords}
        name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        words = [one.value for one in (*node.args, *(k.value for k in node.keywords)) if isinstance(one, ast.Constant)]
        binary = any(isinstance(one, str) and "b" in one and len(one) <= 3 for one in words)
        text = name in ("read_text", "write_text") or (
            name == "open" and isinstance(node.func, ast.Name) and not binary
        )
        pipe = name in ("run", "Popen", "check_output") and given & {"text", "universal_newlines"}
        if (text or pipe) and "encoding" not in given and not (name == "read_text" and node.args):
            yield f"{node.lineno}: {ast.unparse(node)[:60]}"


@pytest.mark.parametrize("find", [unguarded, without_encoding])
def test_the_package_asks_for_nothing_that_is_only_here(find: object) -> None:
    assert callable(find)
    texts = {path.relative_to(PACKAGE): path.read_text(encoding="utf-8") for path in FILES}
    found = [f"{path}:{one}" for path, text in texts.items() for one in find(text)]
    assert [one for one in found if find is unguarded or Path(one.partition(":")[0]) not in DIGITS] == []


def test_no_process_is_forked_and_none_is_started_by_a_shell() -> None:
    for path in FILES:
        source = path.read_text(encoding="utf-8")
        assert 'get_context("fork")' not in source and 'set_start_method("fork")' not in source, path
        assert "shell=True" not in source and "os.system(" not in source, path


@pytest.mark.parametrize(
    ("source", "said"),
    [
        ("import fcntl", ["1: fcntl"]),
        ("try:\n    import fcntl\nexcept ImportError:\n    fcntl = None", []),
        ("import os\nos.getuid()", ["2: os.getuid"]),
        ("import os\nwho = os.getuid() if hasattr(os, 'getuid') else 0", []),
        ("import os\ndef f():\n    if os.name == 'nt':\n        return\n    os.chown(1, 2, 3)", []),
        ("import os\ndef f():\n    os.chown(1, 2, 3)\n    if os.name == 'nt':\n        return", ["3: os.chown"]),
        ("from os import fork", ["1: os.fork"]),
        ("import signal\nwith suppress(AttributeError):\n    signal.SIGHUP", []),
        ("import signal\nwith suppress(OSError):\n    signal.SIGHUP", ["3: signal.SIGHUP"]),
    ],
)
def test_the_judge_sees_what_it_looks_for(source: str, said: list[str]) -> None:
    assert list(unguarded(source)) == said


@pytest.mark.parametrize(
    ("source", "count"),
    [("p.read_text()", 1), ("p.write_text(x)", 1), ("p.read_text('utf-8')", 0), ("open(p)", 1), ("open(p, 'rb')", 0),
     ("run(x, text=True)", 1), ("run(x, text=True, encoding='utf-8')", 0), ("p.write_text(x, encoding='utf-8')", 0)],
)  # fmt: skip
def test_it_sees_text_without_an_encoding(source: str, count: int) -> None:
    assert len(list(without_encoding(source))) == count
