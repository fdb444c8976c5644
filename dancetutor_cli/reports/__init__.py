"""The output of a run: text, JSON, CSV, SARIF and other formats, the page of a pack, the chart sheet.

analyze_formats               formats of `analyze` by name, and what each of them implements
tally, moments                the counts of a run and its exit status; where in a song, for people
brief, text_report            for people: a screen, or all of it; terminal makes text safe and coloured
data_formats, code_formats    for programs; for code review
rule_pages                    the documentation of a rule
pack, pack_page               a pack as facts and lines; as a page
tech_counts                   our technique counts beside the game's
sheet, sheet_places, sheet_drawing    the chart sheet
motion_report, sync_plot      of `animate` and `retarget`; of `analyze --sync`
svg                           pieces of SVG, for all pictures
"""
