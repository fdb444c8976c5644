"""Bytes of a chart file -> Song and Chart; what a path means: packs, pairs of .sm and .ssc, selection, the music.

reader.load                   the way in; a file is read in four steps
  |   msd                       its tags, with the place of each value
  |   timing_tags, timing       when a beat is
  |   grid, cells, note_data    measures and rows; what stands in their cells; notes
  |   ucs                       a UCS file of Pump, which has none of these
model.Song, model.Chart       what every other package works with

selection, pack_files         which charts a path means; settings files that lie beside them
music, audio                  which file is the song's music; its samples
density, hash, names          streams and tempos; how leaderboards know a chart; words of the games
edits, note_writer            the bytes of a file changed in places; notes as bytes
"""
