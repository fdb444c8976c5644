"""What OpenGL is here, found with ctypes alone: before any OpenGL package is imported, whose errors nobody can read."""

from __future__ import annotations

import ctypes
import sys
from functools import cache
from importlib.util import find_spec

from dancetutor_cli.errors import UnavailableError
from dancetutor_cli.extras import how_to_add

MISSING = "No OpenGL found. Debian/Ubuntu: apt-get install libegl1 libgl1. Or use --renderer cpu."
NO_PACKAGE = f"The OpenGL renderer is not installed. {how_to_add('gl')}. Or use --renderer cpu."
_EGL_EXTENSIONS = 0x3055
_PLATFORM_DEVICE = 0x313F
_SOFTWARE = b"EGL_MESA_device_software"
_MOST_DEVICES = 32


def require_gl() -> None:
    """UnavailableError with what to install if pyrender or the system's libraries are not there."""
    if find_spec("pyrender") is None:
        raise UnavailableError(NO_PACKAGE)
    if _library("libEGL.so.1") is None or _library("libGL.so.1") is None:
        raise UnavailableError(MISSING)


@cache
def gpu_device() -> int | None:
    """Number of the first EGL device that is real hardware and starts, or None; also without pyrender, to draw with."""
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
    """A function of an EGL extension; they are not exported by name."""
    egl.eglGetProcAddress.restype = ctypes.c_void_p
    egl.eglGetProcAddress.argtypes = [ctypes.c_char_p]
    address = egl.eglGetProcAddress(name)
    return ctypes.CFUNCTYPE(result)(address) if address else None


def _starts(egl: ctypes.CDLL, display: int) -> bool:
    """A device may be listed and yet be forbidden to this user."""
    egl.eglInitialize.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p]
    egl.eglTerminate.argtypes = [ctypes.c_void_p]
    if not egl.eglInitialize(display, None, None):
        return False
    egl.eglTerminate(display)
    return True
