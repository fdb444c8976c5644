"""Films: the drawing of single pictures, and the way from a request to a file.

The packages `overlay`, `scene` and `media` do not import each other. "She" is the dancer in the picture.

overlay                 the flat layer on top: highway, words, legend, pad diagram, and their sprites and letters
scene                   the three-dimensional part: camera, stage, the dancer's meshes, and the renderers `cpu` and `gl`
media                   everything beside the pictures: ffmpeg, encoder, sound, subtitles
plan                    everything that the frames of a film need, as plain data
film, placement         the film of a plan, which draws its frames with `overlay` and `scene`; where its words stand
work                    the way from a request to a plan to a file; uses all the other parts, and none of them uses it

clock, scroll           the second of the music in each frame; how fast notes scroll
notes                   the chart and its play, timed by the music: notes, presses, beats, lights
layout, choices         layouts, and the look of a film; the names of qualities and renderers
words, picture          the names of moves, and phrases; the frame, the pad and the foot that the parts share
"""
