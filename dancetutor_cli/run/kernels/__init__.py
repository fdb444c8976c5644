"""Kernels, functions that run as machine code.

`compiling` makes the code with numba, `store` stores it, and `native` calls it without numba. Start with `store`, which
describes the files with the code and the processor that they are for.
"""
