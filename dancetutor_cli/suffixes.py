"""What the files of charts are called, in lower case."""

SONG_SUFFIXES = (".sm", ".ssc")
EDIT_SUFFIX = ".edit"  # either form; its charts are Edits, whatever it says
