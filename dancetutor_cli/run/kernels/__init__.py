"""Functions as machine code: `compiling` makes it with numba, `store` keeps it, `native` calls it without numba.

`target` says for which processor. Start with `store`, where the form of a kept file stands.
"""
