"""The rules of the linter: each rule is a class, and each module has the rules of one theme.

A new rule needs a subclass of `FileRule` or `ChartRule` whose docstring documents it, an entry in
configs/lint/default.yaml, and passing and failing cases in tests/lint/cases/.

Other packages use the attributes of a rule's class (`rule.Rule`). Only these name rules by their codes:

    lint.fix_edits RULES                    rules whose findings safe fixes remove
    lint.analysis _unreadable               the finding of a file that cannot be read
    lint.check _AMBIGUITY, _NO_PAD          what becomes of a finding with unsure feet; what a chart without a pad has
    lint.figures _DOUBLESTEP                the rule whose findings get causes
    film.overlay.callouts _OF_PASSAGES, _OF_MINES   rules with one finding for a whole passage; the rule about mines
    reports.pack _MUSIC, _PAIR              what is missing or differs in a pack
    reports.rule_pages _UNITS               units of options
"""
