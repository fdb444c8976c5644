"""How hard a chart is to pass, by the meter of its labels, and to score on, by tiers; each with its terms.

model, estimate               numbers of a play, and curves over them, by a fit; the meter on the scale of its song
score                         what makes a chart hard to score on; the tier
song                          all charts of a song together: each needs the others to know its scale
"""
