"""How hard a chart is to pass, by the meter of its labels, and to score on, by tiers; each with its bill."""
