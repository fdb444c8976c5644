"""`dancetutor completion`: the Tab key completes commands, options and names, in bash, zsh, fish and PowerShell."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import click
from click.shell_completion import BashComplete, ShellComplete, add_completion_class, get_completion_class

from dancetutor_cli.commands.option_groups import GroupedCommand
from dancetutor_cli.run.errors import FileError, UsageError

PROGRAM, VARIABLE = "dancetutor", "_DANCETUTOR_COMPLETE"
SHELLS = ("bash", "zsh", "fish", "powershell")
_BEGIN, _END = "# >>> dancetutor completion >>>", "# <<< dancetutor completion <<<"


@add_completion_class
class PowerShell(ShellComplete):
    """Completion in PowerShell, which click lacks. The words, and the word to complete, come in variables."""

    name = "powershell"
    source_template = """\
Register-ArgumentCompleter -Native -CommandName %(prog_name)s -ScriptBlock {
    param($wordToComplete, $commandAst, $cursorPosition)
    $env:COMP_WORDS = ($commandAst.CommandElements | ForEach-Object { $_.ToString() }) -join "`n"
    $env:COMP_CWORD = $wordToComplete
    $env:%(complete_var)s = "powershell_complete"
    %(prog_name)s | ForEach-Object {
        $kind, $value, $help = $_.Split("`t", 3)
        if ($kind -eq "plain") {
            [System.Management.Automation.CompletionResult]::new($value, $value, "ParameterValue", ($help + " "))
        }
    }
    Remove-Item Env:COMP_WORDS, Env:COMP_CWORD, Env:%(complete_var)s
}
"""

    def get_completion_args(self) -> tuple[list[str], str]:
        """Return the words before, without the program's name, and the word to complete, which may be empty."""
        words = os.environ.get("COMP_WORDS", "").split("\n")[1:]
        incomplete = os.environ.get("COMP_CWORD", "")
        return (words[:-1] if incomplete and words else words), incomplete

    def format_completion(self, item: click.shell_completion.CompletionItem) -> str:
        """Return a line with kind, value and help, separated by tabs."""
        return f"{item.type}\t{item.value}\t{item.help or ''}"


@click.command(cls=GroupedCommand)
@click.argument("shell", required=False, type=click.Choice(SHELLS))
@click.option("--print", "only_print", is_flag=True, help="Print the script instead of installing it.")
@click.option("--remove", is_flag=True, help="Remove the installed script.")
def command(shell: str | None, only_print: bool, remove: bool) -> None:
    """Make the Tab key complete commands, options and names.

    Name the shell, or leave it out for the one that you use now. Completion works in windows that you open afterwards.
    """
    name = shell or running_shell()
    script = script_for(name)
    if only_print:
        click.echo(script, nl=False)
        return
    place, alone = place_for(name)
    old = _read(place)
    new = _without(old) if not alone else ""
    if not remove:
        new = script if alone else _with(new, script)
    if new == old:
        click.echo(f"{place}: {'nothing to remove' if remove else 'is up to date'}")
        return
    _write(place, new)
    click.echo(f"{place}: {'removed' if remove else 'written'}; this works from the next window of {name} on")


def script_for(shell: str) -> str:
    """Return the script that a shell reads when it starts."""
    if shell == "bash":  # click would run bash to find its version, and there may be no bash
        return BashComplete.source_template % _variables("bash")
    found = get_completion_class(shell)
    assert found is not None
    return found.source_template % _variables(shell)


def _variables(shell: str) -> dict[str, str]:
    return {"complete_func": "_dancetutor_completion", "complete_var": VARIABLE, "prog_name": PROGRAM}


def running_shell() -> str:
    """Return the shell of this user. Raises UsageError for a shell without completion."""
    if sys.platform == "win32":
        return "powershell"
    name = Path(os.environ.get("SHELL", "")).name
    if name in SHELLS:
        return name
    raise UsageError(f"cannot recognise the shell ({name or 'SHELL is not set'}); name one: {', '.join(SHELLS)}")


def place_for(shell: str) -> tuple[Path, bool]:
    """Return the file for the script, and whether it holds nothing else. Raises UsageError without a home folder."""
    try:
        home = Path.home()
    except RuntimeError as error:
        raise UsageError("there is no home folder; dancetutor completion SHELL --print prints the script") from error
    data = Path(os.environ.get("XDG_DATA_HOME") or home / ".local" / "share")
    config = Path(os.environ.get("XDG_CONFIG_HOME") or home / ".config")
    if shell == "fish":
        return config / "fish" / "completions" / f"{PROGRAM}.fish", True
    if shell == "bash" and (Path("/usr/share/bash-completion/bash_completion")).exists():
        return data / "bash-completion" / "completions" / PROGRAM, True
    if shell == "powershell":
        folder = home / "Documents" / "PowerShell" if sys.platform == "win32" else config / "powershell"
        return folder / "Microsoft.PowerShell_profile.ps1", False
    return (home / ".bashrc" if shell == "bash" else Path(os.environ.get("ZDOTDIR") or home) / ".zshrc"), False


def _with(text: str, script: str) -> str:
    """Return the text of a start file with our part at its end."""
    gap = "" if not text or text.endswith("\n") else "\n"
    if "compdef" in script:  # zsh's own completion must be on
        script = f"autoload -Uz compinit && (( $+functions[compdef] )) || compinit\n{script}"
    return f"{text}{gap}{_BEGIN}\n{script.strip()}\n{_END}\n"


def _without(text: str) -> str:
    """Return the text of a start file without our part."""
    before, begun, rest = text.partition(_BEGIN + "\n")
    _, ended, after = rest.partition(_END + "\n")
    return before + after if begun and ended else text


def _read(place: Path) -> str:
    try:
        return place.read_text(encoding="utf-8")
    except FileNotFoundError:
        return ""
    except (OSError, UnicodeDecodeError) as error:
        raise FileError(place, "cannot be read; dancetutor completion SHELL --print prints the script") from error


def _write(place: Path, text: str) -> None:
    from dancetutor_cli.run.files import write_atomic

    try:
        place.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        what = f"its folder cannot be made ({error.strerror}); dancetutor completion SHELL --print prints the script"
        raise FileError(place, what) from error
    if not text:
        place.unlink(missing_ok=True)
        return
    write_atomic(place, text.encode("utf-8"))
