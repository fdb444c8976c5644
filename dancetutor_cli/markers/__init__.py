"""Feet written into chart files and beside them, and removed again.

annotate, plan                  the task of `annotate` for the files of one song; the changes of one file
styles, model                   the styles of markers by name; what all of them share
measure, rows                   feet in comments of the note data
sidecar, smeditor, feet_text    feet in files beside the chart file
edit, theme, background         feet as a chart for two pads; cues for themes; a film behind the notes
"""
