"""The software renderer: triangles drawn by numba kernels, on one core, the same bytes on every run."""
