"""The OpenGL renderer: pyrender without a window, through EGL, with the project's shaders; loaded only on request."""
