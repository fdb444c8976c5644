"""The flat parts of the picture: notes, pads from above, words; whole numbers on sRGB values.

highway, marks, sprites       notes; what stands on and beside them; the pictures they are made of
callouts, phrases, announce   moves that are called out, a passage at a time; in which words; when and where
header, captions, diagram     the song's words; legend, time and density; the pad from above
text, blit                    words as sprites; sprites and shapes on a frame
"""
