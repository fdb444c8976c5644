"""For which processor kernels are compiled, and by what: known without importing numba.

numba compiles for the very processor that it runs on, so what it has compiled fits few others. Here all of them that
can do what most have done since 2013 get the same code: what came compiled with the package fits, a cache in a shared
folder fits every node, and the same numbers come out everywhere.
"""

from __future__ import annotations

import hashlib
import os
import platform
import sys
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

COMPILERS = ("numba", "llvmlite")
_FORM = 7  # of what `store` keeps, and of the options by which it is compiled; count it up with either
LEVEL = "x86-64-v3"  # LLVM's name of the processor
_ABILITIES = (
    *("avx", "avx2", "bmi", "bmi2", "cx16", "f16c", "fma", "lzcnt", "movbe", "popcnt", "sahf"),
    *("sse3", "sse4.1", "sse4.2", "ssse3", "xsave"),
)
_NAME, _FEATURES = "NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES"
_PORTABLE = (LEVEL, ",".join(f"+{one}" for one in _ABILITIES))
# numba's settings that make other code of the same source
_SETTINGS = tuple(
    f"NUMBA_{one}" for one in ("OPT", "BOUNDSCHECK", "DEBUGINFO", "LOOP_VECTORIZE", "SLP_VECTORIZE", "ENABLE_AVX")
)


def pin(config: Any) -> None:
    """Let numba compile for the portable processor, in this process and its workers, unless the user has named one.

    config : `numba.core.config`; to be called before the first kernel is made
    """
    if processor() == _PORTABLE:
        os.environ.update(zip((_NAME, _FEATURES), _PORTABLE, strict=True))
        config.reload_config()


def processor() -> tuple[str, str]:
    """LLVM's names of the processor and of the abilities that are compiled for."""
    name, features = os.environ.get(_NAME), os.environ.get(_FEATURES)
    if name is None and features is None and _is_able():
        return _PORTABLE
    from llvmlite import binding

    if features is None:
        features = "" if name is not None and name.lower() == "generic" else _host_features()
    return (binding.get_host_cpu_name() if name is None else name), features


def is_portable() -> bool:
    """Whether what this process compiles fits others: the portable processor, and no settings of numba's."""
    return not _settings() and processor() == _PORTABLE


@cache
def maker() -> bytes:
    """A digest of what makes machine code of a kernel's source, and for which processor. What differs is not read."""
    versions = [(name, _version(name)) for name in COMPILERS]
    words = repr((_FORM, versions, sys.implementation.cache_tag, processor(), _settings(), sys.platform))
    return hashlib.sha256(words.encode()).digest()


def _settings() -> dict[str, str]:
    return {name: os.environ[name] for name in _SETTINGS if name in os.environ}


def _version(name: str) -> str:
    """The version of a compiler, by the name of what pip leaves beside it if that is clear: an import takes longer."""
    spec = find_spec(name)
    beside = Path(spec.origin).parents[1].glob(f"{name}-*.dist-info") if spec and spec.origin else ()
    versions = [path.stem.removeprefix(f"{name}-") for path in beside]
    return versions[0] if len(versions) == 1 else str(import_module(name).__version__)


@cache
def _is_able() -> bool:
    """Whether this processor can run what is compiled for the portable one."""
    if platform.machine().lower() not in ("x86_64", "amd64"):
        return False
    features = _host_features().split(",")
    return all(f"+{one}" in features for one in _ABILITIES)


def _host_features() -> str:
    from llvmlite import binding

    try:
        return str(binding.get_host_cpu_features().flatten())
    except RuntimeError:  # LLVM does not know
        return ""
