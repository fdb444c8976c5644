"""The work of films: the request, its plan, the segments that other processes draw, batches of films.

request, film_dance           what is wanted, checked; the play and the motions that the film shows
planning                      everything laid on the film's clock
segments, jobs                pieces of a film that any process draws and encodes; the work before and after them
extras                        what is made besides a film: a picture for each row, a poster, subtitles
batch, records                one film or those of folders; which of them are done
motion_film                   a film of a motion without a chart
worker_imports, worker_imports_gl   what processes that draw load once for all of them
"""
