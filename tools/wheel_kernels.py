"""Compile the kernels into a wheel, which then is one for this Python and platform: a build hook of hatchling.

`make wheel` asks for it; other wheels, sdists and editable installs know nothing of it. What is compiled is for a
portable processor (`run/kernels/target.py`), used only by the numba, llvmlite and Python that compiled it.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from importlib.metadata import distribution
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

INSIDE = "dancetutor_cli/_data/kernels"


class KernelsHook(BuildHookInterface):  # type: ignore[type-arg]
    """Adds the kernels that `dancetutor warmup` compiles, below the folders of their modules."""

    PLUGIN_NAME = "custom"

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile; called by hatchling before it packs."""
        if version == "editable":
            return
        self._folder = tempfile.TemporaryDirectory()
        out = Path(self._folder.name) / "kernels"
        compile_into(out, Path(self.root))
        build_data["force_include"][str(out)] = INSIDE
        build_data["pure_python"] = False
        build_data["tag"] = tag()

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Take the folder away; called by hatchling when the wheel is there."""
        if version != "editable":
            self._folder.cleanup()


def compile_into(out: Path, root: Path) -> None:
    """Compile the kernels of the checkout `root` into folders below `out` that are named as their modules' folders."""
    sys.path.insert(0, str(root))  # of this checkout, whatever is installed
    from dancetutor_cli.run.kernels.store import MADE_BY, SUFFIX
    from dancetutor_cli.run.kernels.target import LEVEL, fits_shipped, maker_in_words

    if not fits_shipped():
        sys.exit("kernels for others are compiled on a processor with AVX2, and without settings of numba's")
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder).resolve()  # as the modules there are told where they are: kernels are kept by that
        source, cache = place / "source", place / "cache"
        for name in ("dancetutor_cli", "configs", "charts"):  # a copy: what is kept beside the modules would be fetched
            shutil.copytree(root / name, source / name, ignore=shutil.ignore_patterns("__pycache__", "_data"))
        kept = {key: value for key, value in os.environ.items() if not key.startswith(("NUMBA_", "DANCETUTOR_"))}
        own = {"NUMBA_CACHE_DIR": str(cache), "DANCETUTOR_KERNELS": "compiled", "PYTHONPATH": str(source)}
        command = [sys.executable, "-m", "dancetutor_cli", "warmup", "--quiet"]
        subprocess.run(command, env=kept | own, cwd=source, check=True)
        for made, where in _folders(cache, source / "dancetutor_cli"):
            (out / where).mkdir(parents=True)
            for file in sorted(made.iterdir()):
                if file.suffix == SUFFIX:
                    shutil.copyfile(file, out / where / file.name)
    (out / MADE_BY).write_text(f"{maker_in_words()}, {LEVEL}\n", "utf-8")


def _folders(cache: Path, package: Path) -> Iterator[tuple[Path, Path]]:
    """Each folder of a cache, with the folder of the package whose kernels it has."""
    from dancetutor_cli.run.kernels.store import KernelFolder

    for room in (package, *sorted(path for path in package.rglob("*") if path.is_dir())):
        made = KernelFolder(cache).of_module(room / "module.py")
        if made.is_dir():
            yield made, room.relative_to(package)


def tag() -> str:
    """The wheel's tag: this Python, and the platforms of llvmlite's own wheel; without that nothing here runs.

    Machine code of ours calls nothing of the system's C library but what Python and numba have loaded already.
    """
    from dancetutor_cli.run.kernels.target import COMPILERS

    said = [(distribution(name).read_text("WHEEL") or "").splitlines() for name in COMPILERS]
    tags = [[line.removeprefix("Tag: ").strip() for line in lines if line.startswith("Tag: ")] for lines in said]
    platforms = [{one.rpartition("-")[2] for one in found} for found in tags]
    common = sorted(set.intersection(*platforms))
    if not common:
        sys.exit("numba and llvmlite are not installed as wheels for one platform")
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{'.'.join(common)}"
