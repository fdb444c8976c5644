"""The flat parts of the picture: notes, pads from above, words. The arithmetic uses whole numbers on sRGB values.

highway, marks, sprites       the notes; the marks and words on and beside them; their sprites
free_places                   the places of marks on arrows that overlap
callouts, announce            the passages that are called out; the time and place of calls
header, footer, diagram       the song's words; legend, time and density; the pad from above
text, blit                    words as sprites; sprites and shapes on a frame
"""
