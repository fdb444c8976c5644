"""Chart files: bytes to Song and Chart; also the charts that a path stands for, packs, and the song's music.

reader.load                   the entry point; a file is read in four steps
  |   msd                       tags, with the byte span of each value
  |   timing_tags, timing       timing tags; the second of each beat
  |   grid, cells, note_data    measures and rows; the contents of cells; notes
  |   players                   the parts of charts for several players
  |   ucs                       UCS files of Pump, a different format without these steps
model.Song, model.Chart       what every other package works with

selection                     which charts a path stands for; the songs below folders
pack_files                    settings files beside charts
music, audio                  which file is the song's music; its samples
density, hash, names          streams and tempos; the hash of leaderboards; names from the games
edits                         edits of a file's bytes; notes as bytes
"""
