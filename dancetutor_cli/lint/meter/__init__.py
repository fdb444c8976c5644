"""How hard a chart is: to pass, as a meter on the scale of its label, and to score on, as a tier; each with its terms.

model, estimate               features of a play and fitted curves over them; the meter on the scale of its song
score                         the oddities that make a chart hard to score on; the tier
song                          all charts of a song together, because the scale of a chart depends on the others
"""
