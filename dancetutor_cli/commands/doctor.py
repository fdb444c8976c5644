"""`dancetutor doctor`: what this machine can render with, a line each, and below it the mend of what is missing."""

from __future__ import annotations

import textwrap

import click

WIDTH = 80  # columns


@click.command()
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def command(as_json: bool) -> None:
    """Check renderers, encoders, caches, fonts and disk; says how to mend what is missing.

    Exit status 0 if videos can be made, 2 if not.
    """
    import sys

    from dancetutor_cli.jobs.doctor import examine

    checks = examine()
    if as_json:
        import json

        from dancetutor_cli.workflow_commands import json_without_commands

        rows = [{"name": c.name, "state": c.state, "message": c.message, "mend": c.mend} for c in checks]
        text = json.dumps({"schema": 1, "checks": rows}, ensure_ascii=False, indent=1)
        click.echo(json_without_commands(text))
    else:
        width = max(len(c.name) for c in checks)
        for check in checks:
            _tell(f"{check.state:<7} {check.name:<{width}}  ", check.message.rstrip("."))
            if check.mend:
                _tell(" " * (width + 10), f"mend: {check.mend}")
    if any(check.state == "broken" for check in checks):
        sys.exit(2)


def _tell(head: str, text: str) -> None:
    """One line, and more below its text where it is long; paths are never broken."""
    lines = textwrap.wrap(text, WIDTH - len(head), break_long_words=False, break_on_hyphens=False)
    for number, line in enumerate(lines):
        click.echo(f"{head if number == 0 else ' ' * len(head)}{line}")
