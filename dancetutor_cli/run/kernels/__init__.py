"""Kernels, functions that run as machine code.

`compiling` makes the code with numba, `stored_code` stores it, and `native` calls it without numba. Start with
`stored_code`, which describes the files with the code and the processor that they are for.
"""
