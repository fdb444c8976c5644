"""Compile the kernels into a wheel, which then is one for this Python and platform: a build hook of hatchling.

`make wheel` asks for it; other wheels, sdists and editable installs know nothing of it. What is compiled is for a
portable processor (`run/kernels/stored_code.py`), used only by the numba, llvmlite and Python that compiled it.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from importlib.metadata import distribution
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

SUFFIX = ".kernel"  # as `dancetutor_cli.run.kernels.stored_code` has it


class KernelsHook(BuildHookInterface):  # type: ignore[type-arg]
    """Adds the kernels that `dancetutor warmup` compiles, beside their modules, where an installation keeps its own."""

    PLUGIN_NAME = "custom"

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile; called by hatchling before it packs."""
        if version == "editable":
            return
        self._folder = tempfile.TemporaryDirectory()
        source = compiled_copy(Path(self.root), Path(self._folder.name).resolve())
        for kernel in source.rglob(f"*{SUFFIX}"):
            build_data["force_include"][str(kernel)] = kernel.relative_to(source).as_posix()
        build_data["pure_python"] = False
        build_data["tag"] = tag()

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Take the folder away; called by hatchling when the wheel is there."""
        if version != "editable":
            self._folder.cleanup()


def compiled_copy(root: Path, folder: Path) -> Path:
    """A copy of the checkout `root` in a folder, with its kernels beside the modules."""
    sys.path.insert(0, str(root))  # of this checkout, whatever is installed
    from dancetutor_cli.run.kernels.stored_code import is_portable

    if not is_portable():
        sys.exit("kernels for others are compiled on a processor with AVX2, and without settings of numba's")
    source = folder / "source"
    for name in ("dancetutor_cli", "configs", "charts"):
        shutil.copytree(root / name, source / name, ignore=shutil.ignore_patterns("__pycache__", "_data"))
    kept = {key: value for key, value in os.environ.items() if not key.startswith(("NUMBA_", "DANCETUTOR_"))}
    command = [sys.executable, "-m", "dancetutor_cli", "warmup", "--quiet"]
    environment = kept | {"DANCETUTOR_KERNELS": "compiled", "PYTHONPATH": str(source)}
    subprocess.run(command, env=environment, cwd=source, check=True)
    return source


def tag() -> str:
    """The wheel's tag: this Python, and the platforms of llvmlite's own wheel; without that nothing here runs.

    Machine code of ours calls nothing of the system's C library but what Python and numba have loaded already.
    """
    from dancetutor_cli.run.kernels.stored_code import COMPILERS

    said = [(distribution(name).read_text("WHEEL") or "").splitlines() for name in COMPILERS]
    tags = [[line.removeprefix("Tag: ").strip() for line in lines if line.startswith("Tag: ")] for lines in said]
    platforms = [{one.rpartition("-")[2] for one in found} for found in tags]
    common = sorted(set.intersection(*platforms))
    if not common:
        sys.exit("numba and llvmlite are not installed as wheels for one platform")
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{'.'.join(common)}"
