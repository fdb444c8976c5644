"""The rules of the linter: a class each, in a module per theme.

A new rule: a subclass of `FileRule` or `ChartRule` whose docstring documents it, an entry in
configs/lint/default.yaml, and passing and failing cases in tests/lint/cases/.

What the rest of the house knows of a rule are attributes of its class (`rule.Rule`), but for two tables by code:

    lint.fix_edits RULES         rules whose findings other safe edits remove
    film.overlay.callouts _OF_PASSAGES   rules with one finding for a whole passage
"""
