"""Mending findings in the file itself: the smallest edit of the notes as bytes, proved by solving the chart again."""
