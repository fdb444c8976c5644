"""The frame of every HTML page that the program writes: one file that loads nothing from elsewhere."""

from __future__ import annotations

from html import escape

# The policy of a page without scripts, whose elements may have inline styles.
NO_SCRIPT = "default-src 'none'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'"


def page(policy: str, title: str, style: str, body: str, *, language: str = "en", head: str = "") -> str:
    """Return a whole HTML page.

    policy : the Content-Security-Policy; title : text; style : CSS; body : markup; head : additional markup for the
    head
    """
    return f"""<!DOCTYPE html>
<html lang="{language}">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="referrer" content="no-referrer">
<title>{escape(title)}</title>
{head}<style>{style}</style>
</head>
<body>
{body}</body>
</html>
"""
