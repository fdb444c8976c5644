"""The rules of the linter: a class each, in a module per theme.

A new rule: a subclass of `FileRule` or `ChartRule` whose docstring documents it, an entry in
configs/lint/default.yaml, and passing and failing cases in tests/lint/cases/.
"""
