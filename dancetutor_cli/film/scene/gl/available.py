"""The search for OpenGL with ctypes alone, the corrections before the import of pyrender, and the shaders."""

from __future__ import annotations

import ctypes
import os
import sys
import types
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from dancetutor_cli.run.errors import UnavailableError, install_command

# The search for OpenGL on this machine uses ctypes alone, because OpenGL packages raise unreadable errors on import.

MISSING = "No OpenGL found. Debian/Ubuntu: apt-get install libegl1 libgl1. Or use --renderer cpu."
NO_PACKAGE = f"The OpenGL renderer is not installed. {install_command('gl')}. Or use --renderer cpu."
_EGL_EXTENSIONS = 0x3055
_PLATFORM_DEVICE = 0x313F
_SOFTWARE = b"EGL_MESA_device_software"
_MOST_DEVICES = 32


def require_gl() -> None:
    """Raise UnavailableError, with the packages to install, if pyrender or the system's libraries are missing."""
    if find_spec("pyrender") is None:
        raise UnavailableError(NO_PACKAGE)
    if _library("libEGL.so.1") is None or _library("libGL.so.1") is None:
        raise UnavailableError(MISSING)


@cache
def gpu_device() -> int | None:
    """Return the number of the first EGL device that is real hardware and starts, or None, also without pyrender."""
    if find_spec("pyrender") is None or not sys.platform.startswith("linux") or _library("libGL.so.1") is None:
        return None
    egl = _library("libEGL.so.1")
    if egl is None:
        return None
    query = _function(egl, b"eglQueryDevicesEXT", ctypes.c_uint)
    describe = _function(egl, b"eglQueryDeviceStringEXT", ctypes.c_char_p)
    display_of = _function(egl, b"eglGetPlatformDisplayEXT", ctypes.c_void_p)
    if query is None or describe is None or display_of is None:
        return None
    devices, count = (ctypes.c_void_p * _MOST_DEVICES)(), ctypes.c_int(0)
    if not query(ctypes.c_int(_MOST_DEVICES), devices, ctypes.byref(count)):
        return None
    for number in range(count.value):
        device = ctypes.c_void_p(devices[number])
        extensions = describe(device, ctypes.c_int(_EGL_EXTENSIONS))
        if extensions is None or _SOFTWARE in extensions.split():
            continue
        display = display_of(ctypes.c_uint(_PLATFORM_DEVICE), device, None)
        if display and _starts(egl, display):
            return number
    return None


@cache
def _library(name: str) -> ctypes.CDLL | None:
    try:
        return ctypes.CDLL(name)
    except OSError:
        return None


def _function(egl: ctypes.CDLL, name: bytes, result: type) -> ctypes._FuncPointer | None:
    """Return a function of an EGL extension, which the library does not export by name."""
    egl.eglGetProcAddress.restype = ctypes.c_void_p
    egl.eglGetProcAddress.argtypes = [ctypes.c_char_p]
    address = egl.eglGetProcAddress(name)
    return ctypes.CFUNCTYPE(result)(address) if address else None


def _starts(egl: ctypes.CDLL, display: int) -> bool:
    """Whether a device starts: a device may be listed, but forbidden to this user."""
    egl.eglInitialize.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p]
    egl.eglTerminate.argtypes = [ctypes.c_void_p]
    if not egl.eglInitialize(display, None, None):
        return False
    egl.eglTerminate(display)
    return True


# Corrections without which pyrender 0.1.45 and PyOpenGL 3.1.0 (unchanged since 2022) cannot be imported.
#
# Call `load_pyrender` instead of importing pyrender.
#
# - PyOpenGL chooses its platform when it is imported: PYOPENGL_PLATFORM=egl draws without a screen.
# - pyrender 0.1.45 uses ``np.infty``, which NumPy 2.0 removed.
# - pyrender 0.1.45 imports its viewer window on import, and with it pyglet and libXrender; pyglet 2 lacks a name that
#   the viewer needs. A module in its place has the only name that pyrender needs.
# - Python 3.12 moved the type of byref() to ``_ctypes.CArgObject``, for which PyOpenGL 3.1.0 has no format handler:
#   arguments passed by reference fail with "No array-type handler". The type is registered under its new name.
# - PyOpenGL checks for errors after each call, which takes more time than the call. This check is switched off
#   (`renderer` checks once a frame). PyOpenGL 3.1.0 then leaves out a name in OpenGL.raw.EGL._errors that its own EGL
#   modules need.


def load_pyrender() -> Any:
    """Return pyrender with the corrections; UnavailableError with one readable line if there is no OpenGL."""
    require_gl()
    chosen = os.environ.get("PYOPENGL_PLATFORM")
    if "OpenGL" in sys.modules and chosen != "egl":
        raise UnavailableError("another part of this program uses OpenGL on a screen; use --renderer cpu")
    os.environ["PYOPENGL_PLATFORM"] = "egl"
    if not hasattr(np, "infty"):
        np.infty = np.inf  # type: ignore[attr-defined]
    if "pyrender.viewer" not in sys.modules:
        stand_in = types.ModuleType("pyrender.viewer")
        stand_in.Viewer = object  # type: ignore[attr-defined]
        sys.modules["pyrender.viewer"] = stand_in
    try:
        import OpenGL

        OpenGL.ERROR_CHECKING = False
        OpenGL.ERROR_LOGGING = False
        _register_references()
        import OpenGL.raw.EGL._errors

        if not hasattr(OpenGL.raw.EGL._errors, "_error_checker"):
            OpenGL.raw.EGL._errors._error_checker = None
        import pyrender
        import pyrender.platforms.egl
    except (ImportError, OSError, AttributeError, RuntimeError) as error:
        raise UnavailableError(f"{MISSING} ({' '.join(str(error).split())})") from error
    return pyrender


def _register_references() -> None:
    """Add the type of byref() to the types of PyOpenGL's handler for ctypes arguments, if it is missing."""
    from OpenGL.plugins import FormatHandler

    kind = type(ctypes.byref(ctypes.c_int()))
    name = f"{kind.__module__}.{kind.__name__}"
    handler = FormatHandler.by_name("ctypesparameter")
    if handler is not None and name not in handler.check:
        handler.check.append(name)


# The folder of the shaders, and their form for WebGL 2, which differs from desktop OpenGL only in the first lines.

SHADERS = Path(__file__).resolve().parent / "shaders"
_DESKTOP = "#version 330 core"
_WEB = """#version 300 es
precision highp float;
precision highp int;
precision highp sampler2DShadow;"""


def web_source(text: str) -> str:
    """Return a shader's text for WebGL 2. ValueError for a text without the first line of a desktop shader."""
    if not text.startswith(_DESKTOP):
        raise ValueError(f"a shader begins with '{_DESKTOP}'")
    return _WEB + text[len(_DESKTOP) :]
