"""Functions take at most six parameters: what belongs together travels as a record, in numba's kernels too."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MOST = 6


def parameters(function: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    """How many a caller sees: without `self`; all that `*` or `**` takes counts as one."""
    given = function.args
    names = [one.arg for one in (*given.posonlyargs, *given.args, *given.kwonlyargs)]
    return len(names) - (names[:1] in (["self"], ["cls"])) + (given.vararg is not None) + (given.kwarg is not None)


def too_many(path: Path) -> Iterator[str]:
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and parameters(node) > MOST:
            yield f"{path.relative_to(ROOT)}:{node.lineno} {node.name} takes {parameters(node)}"


def test_no_function_takes_more_than_six() -> None:
    """Of the package or its tools."""
    files = [path for part in ("dancetutor_cli", "tools", "research") for path in (ROOT / part).rglob("*.py")]
    assert len(files) > 350
    assert [line for path in sorted(files) for line in too_many(path)] == []
