"""The dance of a chart: a request, the feet that are found for it, and the performance from which every cut comes."""
