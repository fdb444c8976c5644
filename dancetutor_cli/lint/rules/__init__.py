"""The rules of the linter, one file each.

A new rule: a module here with a subclass of `FileRule` or `ChartRule` whose docstring documents it, an entry in
configs/lint/default.yaml, and passing and failing cases in tests/lint/cases/.
"""
