"""Feet written into chart files and beside them, and taken out again.

annotate                      the piece of work of `annotate`: the files of one song
planning                      what would change, before anything is written
comments, edit, sidecar       feet in comments, as a chart for two pads, in files beside it
theme, background             cues for themes; a film behind the notes
"""
