"""Films: one picture of a plan, and from a request to a file. `overlay`, `scene` and `media` do not import each other.

"She" is the dancer who is in the picture.

overlay   flat, on top: highway, captions, pad diagram, words, and the sprites and letters they are made of
scene     in space: camera, stage, the dancer's meshes, and the renderers `cpu` and `gl` that draw her
media     outside of the picture: ffmpeg, encoder, sound, subtitles
plan      everything that the frames of a film need, as plain data; film draws a frame of it with overlay and scene
work      from a request to a plan to a file: it uses all of the others, and none of them uses it
the rest  what several parts need: clock, layout, notes, scroll, words, choices (of quality and renderer), picture
"""
