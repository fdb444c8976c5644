"""The practice page: one HTML file in which the dancer plays a chart and waits for anyone who learns it.

    work                          a request in, a page out; a folder of them
    content, facts                chart, feet and dancer as data; what is said of them in words
    capture                       a capture beside what `retarget` made of it
    document                      data, style and modules in one file that loads nothing

The page itself is `js/`, `page.css`, `capture.css` and `index.css`, its words `configs/languages`;
docs/page.schema.json says what the data are.
"""
