"""The output of a run: text, JSON, CSV, SARIF and other formats, the page of a pack, the chart sheet.

formats                       formats of `analyze` by name, and what each of them implements
brief, text_report            for people: a screen, or all of it; terminal makes text safe and coloured
data_formats, code_formats    for programs; for code review
pack, pack_page               a pack as facts and lines; as a page
sheet, sheet_places, sheet_drawing    the chart sheet
motion_report, sync_plot      of `animate`; of `analyze --sync`
"""
