"""Pieces of SVG: elements with short numbers, texts made safe and escaped."""

from __future__ import annotations

from xml.sax.saxutils import escape, quoteattr

from dancetutor_cli.reports.terminal import safe


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
        texts.append(f" {key.rstrip('_').replace('_', '-')}={quoteattr(text)}")
    return f"<{name}{''.join(texts)}>{inside}</{name}>" if inside else f"<{name}{''.join(texts)}/>"


def text(content: str, x: float, y: float, class_: str, **attributes: object) -> str:
    """Return a line of untrusted text, made safe and escaped."""
    return tag("text", escape(safe(content)), x=x, y=y, class_=class_, **attributes)


def title(content: str) -> str:
    """Return the tooltip of an element."""
    return f"<title>{escape(safe(content))}</title>"
