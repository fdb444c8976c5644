"""Findings: rules and what they need to know of a chart, configuration, baseline, suggestions and fixes, and meters.

run.LintRun                   a run of `analyze`: configuration and rule_settings for each file
  |   analysis                  one file in, one `results.FileResult` out (and kept)
  |   subject                   what a rule looks at: a file, or a chart with its play
  |   plays, candidates         plays of many charts as arrays; the rows that a rule would have to look at
  |   play_facts, note_facts    the same of one chart; facts about its notes and their place in the file
  |   check, rule, rules        rules are run over them
  |   baseline, pack_syncs      findings that were there before; those of a pack's songs together
  |   figures                   what else is said of a chart: other ways, counts
sections                      the part of a chart that a user names: a span, around a finding, a hard passage
findings.Finding              what a rule reports
watch                         files that are saved while `analyze --watch` waits

suggest, edit_shape           small edits that would remove a finding, and what they leave of the chart's shape
fix_edits, fix                fixes as edits of bytes; put into a file and proved, one by one
sync, song_sync               music against beats: the method, a file, the songs of a pack
meter                         how hard a chart is
versions, snapshots           what changed between two versions of a pack, and where the older one comes from
other_foot, techniques        ways with fewer crossed feet; technique counts beside the game's
"""
