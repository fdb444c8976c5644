"""The frame of every HTML page that the program writes, one file that loads nothing; pieces of SVG."""

from __future__ import annotations

from html import escape

from dancetutor_cli.run.foreign_text import safe

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


# Pieces of SVG: elements with short numbers, texts made safe and escaped.


def number(value: float) -> str:
    """Return a number as text with at most one decimal: "3", "2.5"."""
    return f"{value:.1f}".rstrip("0").rstrip(".") if value != 0 else "0"


def tag(name: str, inside: str = "", /, **attributes: object) -> str:
    """Return an element. Attributes: underscores stand for hyphens, numbers are shortened, None is left out."""
    texts = []
    for key, value in attributes.items():
        if value is None:
            continue
        text = number(value) if isinstance(value, float | int) else str(value)
        texts.append(f' {key.rstrip("_").replace("_", "-")}="{escape(text)}"')
    return f"<{name}{''.join(texts)}>{inside}</{name}>" if inside else f"<{name}{''.join(texts)}/>"


def text(content: str, x: float, y: float, class_: str | None, **attributes: object) -> str:
    """Return a line of untrusted text, made safe and escaped."""
    return tag("text", escape(safe(content), quote=False), x=x, y=y, class_=class_, **attributes)


def title(content: str) -> str:
    """Return the tooltip of an element."""
    return f"<title>{escape(safe(content), quote=False)}</title>"
