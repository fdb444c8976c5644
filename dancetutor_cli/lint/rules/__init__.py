"""The rules of the linter: each rule is a class, and each module has the rules of one theme.

A new rule needs a subclass of `FileRule` or `ChartRule` whose docstring documents it, an entry in
configs/lint/default.yaml, and passing and failing cases in tests/lint/cases/.

Other packages use the attributes of a rule's class (`rule.Rule`). Only two tables list rules by code:

    lint.fix_edits RULES         rules whose findings safe fixes remove
    film.overlay.callouts _OF_PASSAGES   rules with one finding for a whole passage
"""
