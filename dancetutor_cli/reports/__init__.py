"""The output of a run: text, JSON, CSV, SARIF and other formats, the page of a pack, the chart sheet.

analyze_formats               formats of `analyze` by name; their base class, the counts of a run, places as text
brief, text_report            text for people: at most a screen, or everything
terminal, progress            coloured text; the progress of a film
data_formats, code_formats    formats for programs; formats for code review
rule_pages                    the documentation of a rule
pack, pack_page               a pack as data and lines, with our technique counts beside the game's; a pack as a page
sheet, sheet_places, sheet_drawing    the chart sheet
motion_report, sync_plot      report and plot of `animate` and `retarget`; plot of `analyze --sync`
"""
