"""Feet written into chart files and beside them, and taken out again.

annotate, plan                  the piece of work of `annotate`: the files of one song; what would change in one of them
styles, model                   the styles of markers by name; what all of them share
measure, rows                   feet in comments of the note data
sidecar, smeditor, feet_text    feet in files beside the chart file
edit, theme, background         feet as a chart for two pads; cues for themes; a film behind the notes
"""
