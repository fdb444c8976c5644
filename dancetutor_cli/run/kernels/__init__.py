"""Functions as machine code: `compiling` makes it with numba, `store` keeps it, `native` calls it without numba.

Start with `store`, where the form of a kept file stands and for which processor it is.
"""
