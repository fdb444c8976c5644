"""The base of every package; nothing here depends on charts. Read `errors` and `files` first.

errors, foreign_text    one-line errors; untrusted text made harmless in terminals, CSV files, CI logs
reading, files          reading with limits of size and kind; writing of whole files or nothing
schema, yaml_files      settings files as dataclasses, each error with its line
languages               the texts for players, by language, from configs/languages
pool                    workers in this process, in other processes (`worker_processes`) or on a cluster
process, preload        the streams of this process, and Ctrl-C; the import that worker processes share
stored_files            the keys and files of stored results, and the removal of old ones
trust                   the folders from which results and machine code are loaded
kernels                 functions that run as machine code, by numba
ffmpeg, pictures        films and music; pictures
markup                  the frame of every HTML page; pieces of SVG
"""
