"""The base of every package; nothing here knows of charts. Read `errors` and `files` first.

errors, foreign_text    one line for each error; text of strangers made harmless in CSV and in logs of CI
reading, files          bytes in, bounded in size and kind; files out, whole or not at all
schema, yaml_files      settings files into dataclasses, each error with its line
languages               what players read, by language, from configs/languages
pool                    pieces of work in, results out: in this process, in others (`worker_processes`), on a cluster
process, preload        this process: its streams, Ctrl-C; what worker processes have in common
fingerprint, trust      keys of kept results; the folders from which they and machine code are taken
kernels                 functions as machine code, by numba
ffmpeg, pictures, html  what writes and reads films, music and pictures; the frame of every HTML page
"""
