"""`dancetutor analyze --fix`: what is written is what was asked for, proved, and nothing else."""

from __future__ import annotations

import os
import re
import subprocess
from collections import Counter
from pathlib import Path

import pytest
from annotating import POSIX, SONG
from annotating import Said as Annotated
from click.testing import CliRunner

from dancetutor_cli.commands.analyze import command
from dancetutor_cli.commands.fix_option import _Messages
from dancetutor_cli.lint.analysis import analyze_file
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.fix import ALREADY_REMOVED, NO_MOVE, FixOutcome, SkippedFinding
from dancetutor_cli.lint.run import LintRequest, LintRun
from dancetutor_cli.run.errors import DancetutorError, UsageError
from dancetutor_cli.run.files import temporary_name

HARD = ["--steps-type", "dance-single", "--difficulty", "hard"]
BROKEN = (
    "#TITLE:T;\n#BPMS:0=120;\n#NOTES:dance-single::Hard:9::\n2001\nM000\n0010\n3000\n,\n4000\n0100\n0001\n0010\n;\n"
)


class Said:
    """How `analyze` ended: exit status, standard output and standard error."""

    def __init__(self, *arguments: object) -> None:
        result = CliRunner().invoke(command, [str(a) for a in arguments], standalone_mode=False)
        if result.exception is not None and not isinstance(result.exception, DancetutorError):
            raise result.exception
        self.error = result.exception
        self.status = result.return_value if self.error is None else 2
        self.out, self.err = result.stdout, result.stderr


def found(path: Path) -> Counter[tuple[int, str, float | None]]:
    """How often each rule finds something in each place; DT213 tells the least sure rows, so there others follow."""
    charts = analyze_file(LintRun(LintRequest()).task(path)).charts
    return Counter((c.index, f.rule, f.beat) for c in charts for f in c.findings if f.rule != "DT213")


def changed(before: bytes, after: bytes) -> list[int]:
    assert len(before) == len(after)
    return [n for n, (a, b) in enumerate(zip(before, after, strict=True)) if a != b]


def test_one_finding_is_repaired_by_two_bytes_and_no_other_comes(ssc: Path) -> None:
    before, was = ssc.read_bytes(), found(ssc)
    said = Said(ssc, *HARD, "--fix", "DT202:1")
    assert said.status == 0, said.err
    assert "DT202 spin [dance-single Hard 8] move the note on beat 45.5 from down to up" in said.out
    places = changed(before, ssc.read_bytes())
    assert len(places) == 2 and before.count(b"\n", 0, places[0]) == before.count(b"\n", 0, places[1])
    now = found(ssc)
    assert not now - was
    assert "two_left_feet.sm: the same song in another file, which was not named" in said.err
    assert [rule for _, rule, _ in was - now].count("DT202") == 1


def test_all_findings_of_a_rule_in_both_files_of_a_song(song: Path) -> None:
    was = {path: found(path) for path in song.iterdir()}
    assert Said(song, "--fix", "DT202").status == 0
    for path, before in was.items():
        assert not found(path) - before
        assert not [place for place in found(path) if place[1] == "DT202"]
    notes = [re.sub(rb"[^0-4MLF,\n]", b"", path.read_bytes().split(b"#NOTES:")[-1]).strip() for path in song.iterdir()]
    assert Said(song, "--fix", "DT202", "--diff").out == "" and len(notes) == 2


def test_diff_writes_nothing_and_patch_makes_of_it_what_fix_writes(ssc: Path, tmp_path: Path) -> None:
    before = ssc.read_bytes()
    said = Said(ssc, "--fix", "DT202", "--fix", "safe", "--diff")
    assert said.status == 0 and ssc.read_bytes() == before
    assert said.out.startswith("--- ") and "would move the note" in said.err
    Said(ssc, "--fix", "DT202", "--fix", "safe")
    lines = [line for line in said.out.splitlines() if line[:1] in "+-" and line[:3] not in ("+++", "---")]
    new, old = ssc.read_bytes().decode().splitlines(), before.decode().splitlines()
    pairs = [(a, b) for a, b in zip(old, new, strict=True) if a != b]
    assert lines == [line for a, b in pairs for line in (f"-{a}", f"+{b}")]


def test_safe_makes_only_inaudible_edits(tmp_path: Path) -> None:
    path = tmp_path / "x.sm"
    path.write_text(BROKEN)
    said = Said(path, "--fix", "safe", "--backup")
    assert said.status == 0, said.err
    assert path.read_text() == BROKEN.replace("M000", "0000").replace("4000", "0000")
    assert (tmp_path / "x.sm.bak").read_text() == BROKEN
    assert "remove a mine from under the head of the hold on beat 0" in said.out
    again = Said(path, "--fix", "safe")
    assert "nothing to change" in again.out and again.status == 0


def test_what_went_with_another_edit_is_gone_and_no_failure(capsys: pytest.CaptureFixture[str]) -> None:
    finding = Finding("DT207", "either-foot", "warning", "m", line=4)
    gone, kept = (
        SkippedFinding("dance-single Hard 9", finding, ALREADY_REMOVED),
        SkippedFinding("dance-single Hard 9", finding, NO_MOVE),
    )
    for left, status in ((gone, 0), (kept, 1)):
        messages = _Messages(diff=False)
        messages.show(Path("x.sm"), FixOutcome(unfixed=(left,)))
        assert messages.end() == status
        said = capsys.readouterr().out
        assert ("left alone" in said) == (status == 1) and ("] gone: an earlier edit" in said or status == 1)


def test_an_edit_that_is_not_possible_is_reported_and_left(tmp_path: Path) -> None:
    path = tmp_path / "x.sm"
    path.write_text("#TITLE:T;\n#BPMS:0=120;\n#NOTES:dance-single::Hard:9::\n1000\n0010\n0001\n0000\n0100\n;\n")
    before = path.read_bytes()
    said = Said(path, "--fix", "DT401")
    assert said.status == 1
    assert "DT401 off-grid [dance-single Hard 9] left alone: it is 3 ms or more off the grid" in said.out
    assert path.read_bytes() == before


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--fix", "DT205"], "DT205 crossed-run has no fix; DT201"),
        (["--fix", "DT999"], "there is no rule 'DT999'"),
        (["--fix", "DT202:0"], "write a rule, such as DT202"),
        (["--fix", "DT202:1"], "has 6 charts, so choose one"),
        ([*HARD, "--fix", "DT202:9"], "has 1 finding of DT202"),
        (["--fix", "safe", "--format", "json"], "leave --format out"),
        (["--fix", "safe", "--watch"], "--watch cannot be used with --fix"),
        (["--diff"], "belong to --fix"),
    ],
)
def test_nonsense_is_reported_in_one_line(ssc: Path, options: list[str], message: str) -> None:
    before = ssc.read_bytes()
    said = Said(ssc, *options)
    assert isinstance(said.error, UsageError) and message in str(said.error)
    assert ssc.read_bytes() == before


@POSIX
def test_a_read_only_file_is_reported_and_the_others_go_on(song: Path, ssc: Path) -> None:
    before = ssc.read_bytes()
    ssc.chmod(0o444)
    said = Said(song, "--fix", "DT202")
    assert said.status == 2 and "two_left_feet.ssc: is read-only; nothing was written" in said.err
    assert (
        ssc.read_bytes() == before
        and (song / "two_left_feet.sm").read_bytes() != (SONG / "two_left_feet.sm").read_bytes()
    )


def test_a_file_that_changes_meanwhile_is_left_alone(ssc: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from dancetutor_cli.lint import fix

    write, edited = fix.write_atomic, ssc.read_bytes() + b"// saved by an editor\n"

    def meanwhile(path: Path, data: bytes, *, expect: bytes | None = None) -> None:
        ssc.write_bytes(edited)
        write(path, data, expect=expect)

    monkeypatch.setattr(fix, "write_atomic", meanwhile)
    said = Said(ssc, "--fix", "DT202")
    assert said.status == 2 and "changed by another program" in said.err
    assert ssc.read_bytes() == edited and not temporary_name(ssc).exists()


def test_markers_stay_and_their_author_is_reported(ssc: Path) -> None:
    assert Annotated([ssc]).status == 0
    before = ssc.read_bytes()
    said = Said(ssc, *HARD, "--fix", "DT202")
    assert said.status == 0 and "run `dancetutor annotate` to update them" in said.err
    assert len(changed(before, ssc.read_bytes())) == 2


def test_a_measure_that_somebody_pinned_is_kept_to(ssc: Path) -> None:
    """The edited chart is solved with the wishes in the file, so that no edit makes of them what is worse."""
    Annotated([ssc, *HARD])
    ssc.write_bytes(re.sub(rb"\{dt1 ([^}]*)\}", rb"{dt1! \1}", ssc.read_bytes()))
    was = found(ssc)
    Said(ssc, *HARD, "--fix", "DT202")
    assert not found(ssc) - was


def test_the_installed_command_does_it_too(ssc: Path) -> None:
    tool = Path(os.sys.executable).with_name("dancetutor")  # type: ignore[attr-defined]
    if not tool.exists():
        pytest.skip("the command is not installed beside this Python")
    done = subprocess.run([tool, "analyze", ssc, "--fix", "safe"], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout.strip()) == (0, "1 file: nothing to change")
