"""Places in a song as text: measure, beat and time as players read them."""

from __future__ import annotations

from collections.abc import Sequence

from dancetutor_cli.lint.findings import Finding

_MOST_MEASURES = 6  # that a line lists


def moment(finding: Finding) -> str:
    """Return " measure 4 beat 16 0:07.512", or as much of it as is known."""
    parts = []
    if finding.measure is not None:
        parts.append(f"measure {finding.measure}")
    if finding.beat is not None:
        parts.append(f"beat {round(finding.beat, 3):g}")
    if finding.second is not None:
        parts.append(clock(finding.second))
    return "".join(f" {part}" for part in parts)


def measures_text(findings: Sequence[Finding]) -> str:
    """ ", measures 4 and 18", or as many of them as a line lists; "" if none is known."""
    measures = [str(one) for one in dict.fromkeys(f.measure for f in findings if f.measure is not None)]
    if not measures:
        return ""
    if len(measures) > _MOST_MEASURES:
        return f", measures {', '.join(measures[:_MOST_MEASURES])} ..."
    *before, last = measures
    return f", measures {', '.join(before)} and {last}" if before else f", measure {last}"


def clock(second: float, *, milliseconds: bool = True) -> str:
    """Return seconds as "1:02.500", or "1:02" without milliseconds; negative before the music starts."""
    count = round(abs(second) * 1000)
    minutes, rest = divmod(count, 60_000)
    text = f"{'-' if second < 0 and count else ''}{minutes}:{rest // 1000:02}"
    return f"{text}.{rest % 1000:03}" if milliseconds else text
