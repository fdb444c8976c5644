"""Findings: the rules and the facts about a chart that they need, configuration, baseline, suggestions, fixes, meters.

run.LintRun                   a run of `analyze`: configuration and rule_settings for each file
  |   analysis                  one file in, one `results.FileResult` out (and kept)
  |   subject                   the object that a rule checks: a file, or a chart with its play
  |   plays, candidates         the plays of many charts as arrays; the rows that a rule would have to check
  |   play_facts, note_facts    facts about the play of one chart; facts about its notes and their place in the file
  |   check, rule, rules        the rules, and how they are run over files, charts and packs
  |   baseline                  findings that are accepted
  |   figures                   the rest of the report on a chart: other ways, counts
sections                      the part of a chart that a user names: a span, around a finding, a hard passage
findings.Finding              what a rule reports

suggest, edit_shape           small edits that would remove a finding; the shape of a chart that they must keep
fix_edits, fix                fixes as edits of bytes; the fixes are made in a file and checked one by one
sync, song_sync               the music against the beats: the method; the sync of one file
meter                         how hard a chart is
versions, snapshots           the changes between two versions of a pack; where the older version comes from
other_foot                    ways with fewer crossed feet
technique_rows, techniques    technical steps by ITGmania's rules; their counts beside the game's
"""
