"""A Python file that is in no package, as a module: tools, and kernels that a test has written."""

from __future__ import annotations

import importlib.util
import sys
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

TOOLS = Path(__file__).resolve().parents[1] / "tools"


def loaded(path: Path) -> Any:
    """What the file defines; run anew at each call."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def tool(name: str) -> ModuleType:
    """A module of `tools/`, which may import others there; the test is skipped where the tools are not."""
    if not TOOLS.is_dir():
        pytest.skip("the tools are not in an installed package")
    sys.path.insert(0, str(TOOLS))
    try:
        return import_module(name)
    finally:
        sys.path.remove(str(TOOLS))
