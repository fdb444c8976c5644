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
from typing import Any

COMPILERS = ("numba", "llvmlite")
_FORM = 6  # of what `kernels` writes, and of the options by which it compiles; count it up with either
LEVEL = "x86-64-v3"  # LLVM's name of the processor
_ABILITIES = (
    *("avx", "avx2", "bmi", "bmi2", "cx16", "f16c", "fma", "lzcnt", "movbe", "popcnt", "sahf"),
    *("sse3", "sse4.1", "sse4.2", "ssse3", "xsave"),
)
_NAME, _FEATURES = "NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES"
_PORTABLE = {_NAME: LEVEL, _FEATURES: ",".join(f"+{one}" for one in _ABILITIES)}
# numba's settings that make other code of the same source
_OTHER_CODE = tuple(
    f"NUMBA_{one}" for one in ("OPT", "BOUNDSCHECK", "DEBUGINFO", "LOOP_VECTORIZE", "SLP_VECTORIZE", "ENABLE_AVX")
)


def pin() -> None:
    """Compile for the portable processor, in this process and its workers, unless the user has named one.

    To be called before the first kernel is made.
    """
    from numba.core import config as _config

    config: Any = _config  # has types in some versions only
    named = config.CPU_NAME is not None or config.CPU_FEATURES is not None  # in a file of numba's, maybe
    if not named and _is_able():
        os.environ.update(_PORTABLE)
        config.reload_config()


def fits_shipped() -> bool:
    """Whether this process compiles as those kernels were compiled that come with the package."""
    if any(name in os.environ for name in _OTHER_CODE):
        return False
    named = {name: os.environ[name] for name in _PORTABLE if name in os.environ}
    return named == _PORTABLE or (not named and _is_able())


def target() -> str:
    """The processor that this process compiles for: what was compiled for another is none of its business."""
    named = [os.environ.get(name, "") for name in _PORTABLE]
    if any(named):
        return " ".join(named)
    if _is_able():
        return " ".join(_PORTABLE.values())
    from llvmlite import binding

    return f"{binding.get_host_cpu_name()} {binding.get_host_cpu_features().flatten()}"


@cache
def maker() -> bytes:
    """A digest of what makes machine code of a kernel's source; 32 bytes. What another has made is not even read."""
    settings = {name: os.environ[name] for name in _OTHER_CODE if name in os.environ}
    return hashlib.sha256(f"{_FORM}, {maker_in_words()}, {target()}, {settings}".encode()).digest()


def maker_in_words() -> str:
    """What compiles here; all of this must be the same where it is used."""
    return ", ".join([*(f"{name} {_version(name)}" for name in COMPILERS), f"Python {sys.implementation.cache_tag}"])


def _version(name: str) -> str:
    """The version of a compiler; by the name of what pip leaves beside it, if that is clear: to ask takes longer."""
    import importlib.util

    spec = importlib.util.find_spec(name)
    if spec is not None and spec.origin is not None:
        beside = os.listdir(os.path.dirname(os.path.dirname(spec.origin)))  # noqa: PTH120, PTH208
        found = [one for one in beside if one.startswith(f"{name}-") and one.endswith(".dist-info")]
        if len(found) == 1:
            return found[0].removeprefix(f"{name}-").removesuffix(".dist-info")
    from importlib import metadata

    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:  # a program that was frozen into one file
        return str(import_module(name).__version__)


@cache
def _is_able() -> bool:
    """Whether this processor can run what is compiled for the portable one."""
    if platform.machine().lower() not in ("x86_64", "amd64"):
        return False
    from llvmlite import binding

    try:
        features = binding.get_host_cpu_features()
    except RuntimeError:  # LLVM does not know
        return False
    return all(features.get(one, False) for one in _ABILITIES)
