"""The parts of a film besides its pictures: encoded files, sound, subtitles, and all calls of ffmpeg."""
