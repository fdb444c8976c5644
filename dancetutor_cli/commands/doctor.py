"""`dancetutor doctor`: what this machine can render with, one line each, with the mend where something is missing."""

from __future__ import annotations

import click


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

        rows = [{"name": c.name, "state": c.state, "message": c.message, "mend": c.mend} for c in checks]
        click.echo(json.dumps({"schema": 1, "checks": rows}, ensure_ascii=False, indent=1))
    else:
        width = max(len(c.name) for c in checks)
        for check in checks:
            message = f"{check.message.rstrip('.')}. Mend: {check.mend}" if check.mend else check.message
            click.echo(f"{check.state:<7} {check.name:<{width}}  {message}")
    if any(check.state == "broken" for check in checks):
        sys.exit(2)
