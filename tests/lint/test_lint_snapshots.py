"""Versions to compare with that nobody keeps by hand: the last run, and revisions of a git that may be hostile."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from dancetutor_cli.commands import cli
from dancetutor_cli.lint import snapshots
from dancetutor_cli.run.errors import UsageError
from dancetutor_cli.run.trust import CACHE_VARIABLE

SONG = "#TITLE:T;\n#OFFSET:0;\n#BPMS:0=120;\n#NOTES:dance-single:C:Easy:3::\n1000\n0000\n0001\n0000\n;\n"
EDITED = SONG.replace("0001", "0100")
NO_CHANGE = ""
ONE_ROW = "a/a.sm [dance-single Easy 3]: 1 row changed\n  measure 0 beat 2: 0001 → 0100\n"
needs_git = pytest.mark.skipif(shutil.which("git") is None, reason="no git here")


@pytest.fixture
def pack(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A pack of one song, with a cache of its own."""
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))
    for name in ("GIT_CONFIG_GLOBAL", "GIT_CONFIG_SYSTEM"):
        monkeypatch.setenv(name, os.devnull)
    (tmp_path / "pack" / "a").mkdir(parents=True)
    (tmp_path / "pack" / "a" / "a.sm").write_text(SONG, encoding="utf-8")
    return tmp_path / "pack"


def analyze(*words: object) -> Result:
    return CliRunner().invoke(cli, ["analyze", *map(str, words)], standalone_mode=False)


def changes(pack: Path, other: str, *words: str) -> str:
    """What --compare prints, without the line that says how much it is."""
    result = analyze(pack, "--compare", other, *words)
    assert result.exception is None, result.exception
    assert result.stderr == "" and result.return_value == 0
    head, _, rest = result.stdout.partition("\n")
    assert head.startswith("changed since " if rest else "no changes since ")
    return rest


def git(folder: Path, *words: str) -> str:
    identity = ["-c", "user.name=n", "-c", "user.email=e", "-c", "init.defaultBranch=main"]
    return subprocess.run(["git", *identity, *words], cwd=folder, check=True, capture_output=True, text=True).stdout


@pytest.fixture
def versions(pack: Path) -> Path:
    """The pack in a repository, where its song was edited once."""
    git(pack, "init", "-q")
    for text in (SONG, EDITED):
        (pack / "a" / "a.sm").write_text(text, encoding="utf-8")
        git(pack, "add", ".")
        git(pack, "commit", "-qm", "x")
    return pack


class TestLastRun:
    def test_it_is_what_analyze_has_read(self, pack: Path) -> None:
        analyze(pack)
        assert changes(pack, "last") == NO_CHANGE
        (pack / "a" / "a.sm").write_text(EDITED, encoding="utf-8")
        assert changes(pack, "last") == changes(pack, "last") == ONE_ROW
        assert changes(pack / "a" / "a.sm", "last") == ONE_ROW.replace("a/", "")
        analyze(pack / "a")
        assert changes(pack, "last") == NO_CHANGE

    def test_files_come_and_go(self, pack: Path) -> None:
        analyze(pack)
        (pack / "a" / "a.sm").rename(pack / "b.sm")
        assert changes(pack, "last") == "a/a.sm: was removed\nb.sm: is new, or was not analyzed before\n"

    def test_without_a_cache_nothing_is_kept(self, pack: Path) -> None:
        analyze(pack, "--no-cache")
        with pytest.raises(UsageError, match=r"no earlier run of analyze on .* is stored"):
            snapshots.snapshot_of_last_run(pack)

    def test_a_damaged_one_is_a_line(self, pack: Path, tmp_path: Path) -> None:
        analyze(pack)
        (kept,) = (tmp_path / "cache" / "charts").iterdir()
        content = kept.read_bytes()
        (pack / "a" / "a.sm").write_text(EDITED, encoding="utf-8")
        kept.write_bytes(content[:-12] + b"\xff" * 12)
        assert "could not be read before" in changes(pack, "last")
        kept.write_bytes(content[:30])
        assert isinstance(analyze(pack, "--compare", "last").exception, UsageError)

    def test_what_is_unchanged_is_not_written_again(self, pack: Path, tmp_path: Path) -> None:
        analyze(pack)
        (kept,) = (tmp_path / "cache" / "charts").iterdir()
        os.utime(kept, (1e9, 1e9 + 1))
        snapshots.ChartStore(kept.parent).keep(pack / "a" / "a.sm")
        assert kept.stat().st_mtime == 1e9 + 1
        snapshots.ChartStore(kept.parent).prune()  # nobody has analyzed it for long
        assert not kept.exists()


@needs_git
class TestRevisions:
    def test_a_folder_and_a_file(self, versions: Path) -> None:
        assert changes(versions, "HEAD") == NO_CHANGE
        assert changes(versions, "HEAD~1") == ONE_ROW
        assert changes(versions / "a", "HEAD~1") == changes(versions / "a" / "a.sm", "HEAD~1")
        assert changes(versions / "a" / "a.sm", "main~1") == ONE_ROW.replace("a/", "")

    def test_what_git_changes_at_line_ends_is_no_change(self, versions: Path) -> None:
        (versions / "a" / "a.sm").write_bytes(EDITED.replace("\n", "\r\n").encode())
        assert changes(versions, "HEAD") == NO_CHANGE

    def test_hooks_set_variables_of_another_repository(self, versions: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setenv("GIT_DIR", str(versions.parent / "nowhere"))
        assert changes(versions, "HEAD~1") == ONE_ROW

    @pytest.mark.parametrize("revision", ["HEAD~9", "nothing", "--output=x", "-h", "HEAD:a", "@{"])
    def test_no_such_revision_is_one_line(self, versions: Path, revision: str) -> None:
        error = analyze(versions, f"--compare={revision}").exception
        assert isinstance(error, UsageError) and "nor a revision" in str(error) and "\n" not in str(error)
        assert not (versions / "x").exists()

    def test_without_a_repository_or_git(self, pack: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        with pytest.raises(UsageError, match="is not in a git repository"):
            snapshots.snapshot_of_revision("HEAD", pack)
        monkeypatch.setenv("PATH", "")
        with pytest.raises(UsageError, match="install git"):
            snapshots.snapshot_of_revision("HEAD", pack)

    def test_git_is_not_taken_from_the_pack(self, versions: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        (versions / "git").write_text("#!/bin/sh\ntouch ran\n")
        (versions / "git").chmod(0o755)
        monkeypatch.chdir(versions)
        monkeypatch.setenv("PATH", f".{os.pathsep}{os.environ['PATH']}")
        assert changes(Path(), "HEAD~1") == ONE_ROW and not (versions / "ran").exists()

    def test_nothing_of_the_packs_repository_runs(self, versions: Path) -> None:
        """Each of these runs a command in some call of git, as the control shows for two of them."""
        ran, command = versions / "ran", f"touch {versions / 'ran'}; false"
        script = versions / ".git" / "hooks" / "post-index-change"
        script.write_text(f"#!/bin/sh\n{command}\n")
        script.chmod(0o755)
        for key, value in (
            ("core.fsmonitor", command), ("core.sshCommand", command), ("core.pager", command),
            ("alias.ls-tree", f"!{command}"),
            ("core.repositoryFormatVersion", "1"),
            ("extensions.partialClone", "origin"), ("remote.origin.promisor", "true"),
            ("remote.origin.url", f"ext::touch {ran}"), ("protocol.ext.allow", "always"),
            ("core.alternateRefsCommand", command), ("diff.external", command), ("filter.x.smudge", command),
        ):  # fmt: skip
            git(versions, "config", key, value)
        (versions / ".gitattributes").write_text("*.sm filter=x diff=x\n")
        blob = git(versions, "rev-parse", "HEAD~1:a/a.sm").strip()
        stored = versions / ".git" / "objects" / blob[:2] / blob[2:]
        kept = stored.read_bytes()
        assert changes(versions, "HEAD~1") == ONE_ROW and not ran.exists()
        stored.unlink()  # as in a partial clone: git would fetch it
        lacks = analyze(versions, "--compare", "HEAD~1")
        assert "a/a.sm: could not be read before: --compare HEAD~1: git: " in lacks.stdout and not ran.exists()
        for words in (("cat-file", "blob", blob), ("status",)):  # the control: called plainly, git runs all of it
            subprocess.run(["git", *words], cwd=versions, capture_output=True, check=False)
            assert ran.exists(), words
            ran.unlink()
        stored.write_bytes(kept)


MEASURE = "0000\n0000\n0000\n0000\n,\n"
HELD = SONG.replace("0001\n0000", "0002\n0003")


class TestMovedNotes:
    """A whole chart at other beats is one line, and a chart of which anything else changed is not."""

    @pytest.fixture
    def moved(self, pack: Path) -> Path:
        (pack / "a" / "a.sm").write_text(HELD, encoding="utf-8")
        analyze(pack)
        return pack / "a" / "a.sm"

    def test_by_a_measure(self, moved: Path) -> None:
        moved.write_text(HELD.replace("1000\n", f"{MEASURE}1000\n"), encoding="utf-8")
        line = "[dance-single Easy 3]: all notes moved 4 beats later; all rows 2000 ms later\n"
        assert changes(moved, "last") == f"a.sm {line}"

    def test_with_the_sync(self, moved: Path) -> None:
        later = HELD.replace("1000\n", f"{MEASURE}1000\n")
        moved.write_text(later.replace("#OFFSET:0", "#OFFSET:2"), encoding="utf-8")
        assert changes(moved, "last").endswith(": all notes moved 4 beats later; at the same times\n")

    def test_back(self, moved: Path) -> None:
        moved.write_text(HELD.replace("1000\n0000\n0002\n0003\n", f"0000\n1000\n0000\n0002\n,\n0003\n{MEASURE[5:]}"))
        analyze(moved)
        moved.write_text(HELD)
        assert changes(moved, "last").endswith(": all notes moved 1 beat earlier; all rows 500 ms earlier\n")

    def test_all_but_the_end_of_a_hold(self, moved: Path) -> None:
        moved.write_text(HELD.replace("1000\n", f"{MEASURE}1000\n").replace("0003\n", f"0000\n,\n0003\n{MEASURE}"))
        said = changes(moved, "last")
        assert "all notes" not in said and said.count("\n") == 5

    def test_all_but_one_note(self, moved: Path) -> None:
        moved.write_text(HELD.replace("1000\n", f"{MEASURE}0100\n"))
        said = changes(moved, "last")
        assert "all notes" not in said and "2 rows added, 2 removed" in said
