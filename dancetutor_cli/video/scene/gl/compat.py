"""Everything that must be mended before pyrender 0.1.45 and PyOpenGL 3.1.0 (upstream rests since 2022) can be imported.

Call `load_pyrender` instead of importing pyrender.

- PyOpenGL chooses its platform when it is imported: PYOPENGL_PLATFORM=egl draws without a screen.
- pyrender 0.1.45 uses ``np.infty``, which NumPy 2.0 took away.
- pyrender 0.1.45 imports its viewer window with pyglet, and with it libXrender, on import; pyglet 2 has not even got
  what it asks for. A module in its place has the one name that pyrender wants.
- Python 3.12 moved the type of byref() to ``_ctypes.CArgObject``, for which PyOpenGL 3.1.0 has no format handler:
  arguments passed by reference fail with "No array-type handler". It is registered under its new name.
- PyOpenGL checks for errors after each call, which costs more than the call. It is switched off (`renderer` asks once a
  frame); PyOpenGL 3.1.0 then leaves out a name in OpenGL.raw.EGL._errors that its own EGL modules want.
"""

from __future__ import annotations

import ctypes
import os
import sys
import types
from typing import Any

import numpy as np

from dancetutor_cli.errors import UnavailableError
from dancetutor_cli.video.scene.gl.available import MISSING, require_gl


def load_pyrender() -> Any:
    """pyrender, mended; UnavailableError with one readable line if there is no OpenGL."""
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
    """Add the type of byref() to those that PyOpenGL's handler for ctypes arguments takes, if it is not there."""
    from OpenGL.plugins import FormatHandler

    kind = type(ctypes.byref(ctypes.c_int()))
    name = f"{kind.__module__}.{kind.__name__}"
    handler = FormatHandler.by_name("ctypesparameter")
    if handler is not None and name not in handler.check:
        handler.check.append(name)
