"""The practice page: one HTML file in which the dancer plays a chart and waits for the learner.

    work                          makes a page from a request, or a folder of pages
    content, facts                chart, feet and dancer as data; the words and facts about them
    capture                       a capture beside the result of `retarget`
    document                      one file of data, style and modules, which loads nothing

The page itself is `js/`, whose modules are listed in `js/README.md`, with `page.css`, `capture.css` and `index.css`.
Its words are in `configs/languages`, and docs/page.schema.json describes its data.
"""
