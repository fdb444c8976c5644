"""The work of films: the request, its plan, the segments that other processes draw, batches of films.

request, film_dance           the checked request; the play and the motions that the film shows
planning                      the plan, with all parts on the film's clock
segments, jobs                pieces of a film that any process draws and encodes; the work before and after them
extras                        the files besides a film: a picture for each row, a poster, subtitles
batch, records                one film or the films of folders; the records of finished films
motion_film                   a film of a motion without a chart
worker_imports, worker_imports_gl   the common imports of the processes that draw
"""
