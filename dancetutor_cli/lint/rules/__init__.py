"""The rules of the linter: a class each, in a module per theme.

A new rule: a subclass of `FileRule` or `ChartRule` whose docstring documents it, an entry in
configs/lint/default.yaml, and passing and failing cases in tests/lint/cases/.

Tables elsewhere name rules by their codes; most rules are in none of them:

    lint.check _OF_ONE_FOOT      of findings that blame the same foot in a row, that of the rule named first is kept
    lint.check _REACH            how many rows apart they may be for that
    lint.check _EDITOR_CODES     what SMEditor calls such findings where a song says which ones to ignore
    lint.suggest FIXED_BY_MOVES  rules whose findings go if a note is moved; _MOVES: the move that must be gone then
    lint.fix_edits RULES         rules whose findings other safe edits remove
    lint.suggest, fix _RANKED    rules that report only the worst rows: a new finding in place of an old one is no harm
    film.overlay.callouts _OF_PASSAGES   rules with one finding for a whole passage
"""
