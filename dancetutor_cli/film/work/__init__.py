"""The work of films: the request, its plan, the segments that other processes draw, batches of films.

request.FilmRequest           what the user wants; a `jobs.FilmJob` adds the file to write
  |   request.look_up           the chart, read and checked -> `FilmSubject`
  |   planning.prepare          the plan, with all parts on the film's clock -> `PreparedFilm`
  |   jobs.open_film            the work before the first frame, with these two -> `OpenedFilm`
  |   segments                  pieces of a film that any process draws and encodes; `FilmRecord`, for later runs
  |   jobs.close_film           the work after the last frame -> `ClosedFilm`
jobs.FilmOutcome              what became of the job; its poster, subtitles and poses are written by `jobs`, too

film_dance                    the play and the motions that the film shows
batch                         one film or the films of folders
motion_film                   a film of a motion without a chart
worker_imports, worker_imports_gl   the common imports of the processes that draw
"""
