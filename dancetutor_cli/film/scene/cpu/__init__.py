"""The software renderer, in which numba kernels draw triangles on one core, with the same bytes in every run."""
