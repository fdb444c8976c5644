"""What a film is besides its pictures: encoded files, sound, subtitles; all calls of ffmpeg."""
