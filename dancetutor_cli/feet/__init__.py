"""Which limb steps which note: pads, limbs, feet that people have set, cost presets, and the solver -> `Play`.

solved.solve_song             solves a song's charts
  |   pads, preset              where panels are; what each undesired thing costs; which preset a chart gets
  |   song_feet                 feet that people have set: annotations in the file, sme (SMEditor), dancetutor.yaml
  |   overrides                 the same for one chart, and the contradictions
  |   play.prepare_all_rows     rows of notes
  |   solver.solve              the play that costs least
solved.Solved                 a chart, its `play.Play`, its pad and preset

limbs, play_json              names and letters of limbs; plays in the JSON of `analyze`
unplayable                    notes that nobody can play
conditions                    which charts an entry of dancetutor.yaml applies to
passages                      the hardest passages of a chart
"""
