"""`analyze --fix` for one file: fixes are made one after the other, and each is checked by reading and solving the file
again.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field

from dancetutor_cli.chart.edits import apply, unchanged, unified
from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.chart.names import TICKS_PER_MEASURE, is_lights
from dancetutor_cli.feet.preset import Preset, preset_for
from dancetutor_cli.lint import fix_edits
from dancetutor_cli.lint.analysis import AnalyzeTask, load_song
from dancetutor_cli.lint.check import check_chart
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.fix_edits import Fix, move_notes, notes_of
from dancetutor_cli.lint.rule import ReaderRule, all_rules
from dancetutor_cli.lint.rule_settings import Settings
from dancetutor_cli.lint.subject import ChartSubject, solved_chart
from dancetutor_cli.lint.suggest import move_edits
from dancetutor_cli.run.errors import FileError, NoChartsError
from dancetutor_cli.run.files import ChangedError, back_up, remove_leftovers, write_atomic

# rules that `--fix` knows a fix for
FIXABLE = (*(code for code, rule in all_rules().items() if rule.fixed_by_moves), *fix_edits.RULES)
NO_MOVE = "every small edit would make a jack, break a motif or cause another finding"
NO_FIX = {
    fix_edits.BROKEN_HOLD: "its chart holds more than plain notes, or the edit would cause another finding",
    fix_edits.OFF_GRID: "it is 3 ms or more off the grid, or the file has no free row for it",
}
ALREADY_REMOVED = "an earlier edit has removed it, too"

NEVER_WRITTEN = "dancetutor never writes a .ucs file; change it in its editor"

PresetOf = Callable[[Chart], Preset]


@dataclass(frozen=True, slots=True)
class AppliedFix:
    """One thing done. finding : the finding it was asked for, None: one of the safe fixes; fix : what was written"""

    chart: str
    fix: Fix
    finding: Finding | None = None


@dataclass(frozen=True, slots=True)
class SkippedFinding:
    """A finding that stays as it is, or has gone without an edit of its own, and why."""

    chart: str
    finding: Finding
    reason: str

    @property
    def is_gone(self) -> bool:
        """Whether an edit made for another one has removed it too."""
        return self.reason == ALREADY_REMOVED


@dataclass(frozen=True, slots=True)
class FixTask:
    """The fixes that are asked for in one file.

    task : the file, with its configuration; safe : the safe fixes are wanted
    findings : those that were asked for, each with the player of a chart for two in whose part it is, else 0
    write : whether the file is written; backup : keep the old bytes beside it
    """

    task: AnalyzeTask
    findings: tuple[tuple[Finding, int], ...]
    safe: bool = False
    write: bool = True
    backup: bool = False


@dataclass(frozen=True, slots=True)
class FixOutcome:
    """What became of a file.

    fixed : what was, or would be, changed; unfixed : findings that were asked for and are as they were; error : or None
    diff : the lines of the change; notes : what to know besides
    """

    fixed: tuple[AppliedFix, ...] = ()
    unfixed: tuple[SkippedFinding, ...] = ()
    error: str | None = None
    diff: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


def fix_file(job: FixTask) -> FixOutcome:
    """Correct one file; the result is checked before it is written. Never raises for errors in the file."""
    try:
        return _fix(job)
    except NoChartsError as error:  # music of a menu: nothing to fix
        return FixOutcome(notes=(str(error),))
    except FileError as error:
        return FixOutcome(error=str(error))
    except OSError as error:
        return FixOutcome(error=str(FileError(job.task.path, error.strerror or str(error))))


def _fix(job: FixTask) -> FixOutcome:
    task = job.task
    song = load_song(task)
    if song.format == "ucs":
        label = song.charts[0].label
        return FixOutcome(unfixed=tuple(SkippedFinding(label, finding, NEVER_WRITTEN) for finding, _ in job.findings))
    if job.write:
        remove_leftovers(task.path.parent)

    def preset_of(chart: Chart) -> Preset:
        return preset_for(chart, task.path, task.presets)

    session = FixSession(song, task.settings, preset_of)
    if job.safe:
        for chart in task.selection.charts(song):
            session.safe(chart.index)
    for finding, player in job.findings:
        session.finding(finding.chart or 0, finding, player)
    new = session.song.data
    if job.write and new != song.data:
        _write(job, song.data, new)
    diff = tuple(unified(str(task.path), song.data, new))
    return FixOutcome(tuple(session.fixed), tuple(session.unfixed), None, diff, tuple(_notes(job, session)))


def _write(job: FixTask, old: bytes, new: bytes) -> None:
    path = job.task.path
    if job.backup:
        back_up(path)
    try:
        write_atomic(path, new, expect=old)
    except ChangedError:
        if path.read_bytes() != new:  # else another run has just done the same
            raise


def _notes(job: FixTask, session: FixSession) -> Iterator[str]:
    """Other things that the author has to do, if something that is played was changed."""
    if all(one.fix.is_silent for one in session.fixed):
        return
    path = job.task.path
    if b"{dt1 " in session.song.data:
        yield f"{path}: the feet in its measures are from before this edit; run `dancetutor annotate` to update them"


def pick(findings: Sequence[tuple[Finding, int]], rule: str, number: int | None) -> tuple[tuple[Finding, int], ...]:
    """The findings of a rule, or the one of that number, from 1; empty if there is none."""
    found = tuple(one for one in findings if one[0].rule == rule)
    return found if number is None else found[number - 1 : number]


# The song on its way from one fix to the next.


@dataclass
class FixSession:
    """A song on its way: `song` is as far as it has come, with its bytes in `song.data`.

    settings : of the rules; preset_of : the costs of each chart
    """

    song: Song
    settings: Settings
    preset_of: PresetOf
    fixed: list[AppliedFix] = field(default_factory=list)
    unfixed: list[SkippedFinding] = field(default_factory=list)
    _latest: _State | None = None

    def safe(self, chart: int) -> None:
        """All safe fixes of a chart: of a rule at once if that brings no finding, else each that brings none."""
        for player in range(max(len(self.song.charts[chart].players), 1)):
            for rule in fix_edits.RULES:
                fixes = [fix for fix in self._safe_fixes(self._part(chart, player + 1)) if fix.rule == rule]
                if fixes and not self._try(self._state(chart, player + 1), fixes):
                    for fix in fixes:
                        self._try(self._state(chart, player + 1), [fix])

    def finding(self, chart: int, finding: Finding, player: int = 0) -> None:
        """Remove one finding of a chart with the smallest edit that does it; `unfixed` says where there is none.

        player : in whose part of a chart for two it was found
        """
        state = self._state(chart, player)
        if not _count(state, finding):
            self.unfixed.append(SkippedFinding(state.chart.label, finding, ALREADY_REMOVED))
            return
        for fix in self._fixes(state, finding):
            if self._try(state, [fix], finding):
                return
        why = NO_FIX.get(finding.rule, NO_MOVE)
        self.unfixed.append(SkippedFinding(state.chart.label, finding, why))

    def _fixes(self, state: _State, finding: Finding) -> Iterator[Fix]:
        if all_rules()[finding.rule].fixed_by_moves:
            preset = self.preset_of(state.chart)
            for edit in move_edits(finding, state.findings, state.subject, self.settings, preset):
                if fix := move_notes(self.song.data, state.chart, finding, edit):
                    yield fix
            return
        for fix in self._safe_fixes(state.chart):
            if fix.rule == finding.rule and finding.line in fix.lines:
                yield fix

    def _safe_fixes(self, chart: Chart) -> list[Fix]:
        """Those of a chart as it is now; of the grid that rule DT401 has for it, none where that rule is off."""
        if is_lights(chart.steps_type):
            return []
        path = self.song.path.absolute()
        rules = self.settings.for_chart(path, chart.written_type, chart.difficulty, chart.meter)
        grid = rules[fix_edits.OFF_GRID]["grid"] if fix_edits.OFF_GRID in rules else [TICKS_PER_MEASURE]
        return fix_edits.safe_fixes(self.song.data, chart, [int(name) for name in grid])

    def _part(self, index: int, player: int) -> Chart:
        """A chart as it is now, or of one for two the part of a player."""
        return _part(self.song, index, player)

    def _state(self, index: int, player: int = 0) -> _State:
        chart = self._part(index, player)
        if self._latest is None or self._latest.chart is not chart:
            self._latest = _State.of(self.song, chart, self.settings, self.preset_of(chart))
        return self._latest

    def _try(self, state: _State, fixes: Sequence[Fix], finding: Finding | None = None) -> bool:
        """Make fixes if the file then reads as it must, the finding is gone and there is no new one."""
        splices = [splice for fix in fixes for splice in fix.splices]
        if len({splice.start for splice in splices}) < len(splices):
            return False
        after = unchanged(self.song, apply(self.song.data, splices), lambda one: one.index == state.chart.index)
        chart = _part(after, state.chart.index, state.chart.player)
        if not _as_meant(state.chart, chart, fixes) or not _is_other_player_unchanged(state.chart, after, fixes):
            return False
        if finding is not None or not all(fix.is_silent for fix in fixes):
            new = _State.of(after, chart, self.settings, self.preset_of(chart))
            if not new.is_no_worse_than(state) or (finding and _count(new, finding) >= _count(state, finding)):
                return False
            self._latest = new
        self.song = after
        self.fixed += (AppliedFix(state.chart.label, fix, finding) for fix in fixes)
        return True


@dataclass(frozen=True, slots=True)
class _State:
    """A chart as it is now, with what the linter finds in it."""

    chart: Chart
    subject: ChartSubject
    findings: tuple[Finding, ...]

    @staticmethod
    def of(song: Song, chart: Chart, settings: Settings, preset: Preset) -> _State:
        subject = solved_chart(song, chart, preset)
        return _State(chart, subject, check_chart(subject, settings))

    def is_no_worse_than(self, before: _State) -> bool:
        """Whether nothing is found that was not found there before.

        Of what the reader warns of only the first few are reported, so there it is the number that counts.
        """
        return not _finding_counts(self.findings) - _finding_counts(before.findings)


def _part(song: Song, index: int, player: int) -> Chart:
    chart = song.charts[index]
    return chart.players[player - 1] if chart.players and player else chart


def _finding_counts(findings: Iterable[Finding]) -> Counter[tuple[str, float | None]]:
    return Counter(
        (one.rule, None if issubclass(all_rules()[one.rule], ReaderRule) else one.beat)
        for one in findings
        if not all_rules()[one.rule].only_worst
    )


def _count(state: _State, finding: Finding) -> int:
    """How many findings of its rule stand in a finding's place."""
    place = (finding.rule, finding.line, finding.beat)
    return sum((one.rule, one.line, one.beat) == place for one in state.findings)


def _is_other_player_unchanged(before: Chart, after: Song, fixes: Sequence[Fix]) -> bool:
    """Whether the other player of a chart for two has the same notes as before, and none where one came to."""
    if before.written is None:
        return True
    places = {(tick, column + before.first_column) for fix in fixes for tick, column, _, _ in fix.come}
    whole = before.written.notes
    mine = {(tick, column + before.first_column) for tick, column, _, _ in notes_of(before.notes)}
    others = set(zip(whole.tick.tolist(), whole.column.tolist(), strict=True)) - mine
    return not places & others and all(
        len(part.notes) + len(before.notes) == sum(len(one.notes) for one in after.charts[before.index].players)
        for part in after.charts[before.index].players
        if part.player != before.player
    )


def _as_meant(before: Chart, after: Chart, fixes: Sequence[Fix]) -> bool:
    """Whether a chart reads as the one before it with these fixes, note by note, and all else is as it was."""
    gone = frozenset(note for fix in fixes for note in fix.gone)
    come = frozenset(note for fix in fixes for note in fix.come)
    same = ("steps_type", "difficulty", "meter", "description", "columns", "timing", "tags", "notes_span")
    notes = notes_of(before.notes)
    return (
        gone <= notes
        and not come & (notes - gone)
        and notes_of(after.notes) == (notes - gone) | come
        and all(getattr(before, name) == getattr(after, name) for name in same)
        and bool((before.rows.tick == after.rows.tick).all())
    )
