"""Films, in parts by what is drawn. No part imports another part; `film` puts them together into one picture.

"She" is the dancer who is in the picture.

overlay   flat, on top: highway, captions, pad diagram, words, and the sprites and letters they are made of
scene     in space: camera, stage, the dancer's meshes, and the renderers `cpu` and `gl` that draw her
media     outside of the picture: ffmpeg, encoder, sound, subtitles
work      from a request to a plan to a file: planning, segments that other processes draw, batches
film      one frame of a `plan.FilmPlan`; beside it what more than one part needs: clock, layout, notes, scroll, words,
          choices (of quality and renderer) and picture (of the pad)
"""
