"""Films: the drawing of single pictures, and the way from a request to a file.

The packages `overlay`, `scene` and `media` do not import each other. "She" is the dancer in the picture.

overlay   the flat layer on top: highway, captions, pad diagram, words, and their sprites and letters
scene     the three-dimensional part: camera, stage, the dancer's meshes, and the renderers `cpu` and `gl`
media     everything beside the pictures: ffmpeg, encoder, sound, subtitles
plan      everything that the frames of a film need, as plain data; `film` draws its frames with `overlay` and `scene`
work      the way from a request to a plan to a file: it uses all the other parts, and none of them uses it
the rest  shared modules: clock, layout, notes, scroll, words, choices (of quality and renderer), picture
"""
