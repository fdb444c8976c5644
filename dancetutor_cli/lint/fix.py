"""`analyze --fix` for one file: each fix is made in turn, then checked by reading and solving the file again."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field

from dancetutor_cli.chart.edits import apply, check_edit, unified_diff
from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.chart.names import TICKS_PER_MEASURE, is_lights
from dancetutor_cli.feet.limbs import MARKER
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
    """A fix that was made. finding : the finding that it removes, None for a safe fix; fix : the edit of the file"""

    chart: str
    fix: Fix
    finding: Finding | None = None


@dataclass(frozen=True, slots=True)
class SkippedFinding:
    """A finding that stays, or that an edit for another finding has removed, with the reason."""

    chart: str
    finding: Finding
    reason: str

    @property
    def is_gone(self) -> bool:
        """Whether an edit for another finding has also removed this finding."""
        return self.reason == ALREADY_REMOVED


@dataclass(frozen=True, slots=True)
class FixTask:
    """The fixes that the user wants in one file.

    task : the file with its configuration; safe : whether the safe fixes are wanted
    findings : the findings to remove, each with the player in whose part of a chart for two it is, else 0
    write : whether the file is written; backup : whether the old bytes are kept beside it
    """

    task: AnalyzeTask
    findings: tuple[tuple[Finding, int], ...]
    safe: bool = False
    write: bool = True
    backup: bool = False


@dataclass(frozen=True, slots=True)
class FixOutcome:
    """The outcome of the fixes in one file.

    fixed : the fixes that were made, or would be; unfixed : wanted findings without a fix, with the reason
    error : a message, or None; diff : the lines of the change; notes : other messages for the user
    """

    fixed: tuple[AppliedFix, ...] = ()
    unfixed: tuple[SkippedFinding, ...] = ()
    error: str | None = None
    diff: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


def fix_file(job: FixTask) -> FixOutcome:
    """Make the fixes in one file; the result is checked before it is written. Errors in the file never raise."""
    try:
        return _fix(job)
    except NoChartsError as error:  # for example the music of a menu: there is nothing to fix
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
            session.make_safe_fixes(chart.index)
    for finding, player in job.findings:
        session.fix(finding.chart or 0, finding, player)
    new = session.song.data
    if job.write and new != song.data:
        _write(job, song.data, new)
    diff = tuple(unified_diff(str(task.path), song.data, new))
    return FixOutcome(tuple(session.fixed), tuple(session.unfixed), None, diff, tuple(_notes(job, session)))


def _write(job: FixTask, old: bytes, new: bytes) -> None:
    path = job.task.path
    if job.backup:
        back_up(path)
    try:
        write_atomic(path, new, expect=old)
    except ChangedError:
        if path.read_bytes() != new:  # if equal, another run has just made the same change
            raise


def _notes(job: FixTask, session: FixSession) -> Iterator[str]:
    """Yield what else the author has to do, if a fix has changed notes that are played."""
    if all(one.fix.is_silent for one in session.fixed):
        return
    path = job.task.path
    if any(MARKER.search(session.song.data, *chart.notes_span) for chart in session.song.charts):
        yield f"{path}: the feet in its measures are from before this edit; run `dancetutor annotate` to update them"


def pick(findings: Sequence[tuple[Finding, int]], rule: str, number: int | None) -> tuple[tuple[Finding, int], ...]:
    """Return all findings of a rule, or only the one with this number, counted from 1; empty if there is none."""
    found = tuple(one for one in findings if one[0].rule == rule)
    return found if number is None else found[number - 1 : number]


# The song after each fix.


@dataclass
class FixSession:
    """A song and the fixes made so far: `song` is the song after the last fix, with its bytes in `song.data`.

    settings : settings of the rules; preset_of : function that gives the cost preset of a chart
    """

    song: Song
    settings: Settings
    preset_of: PresetOf
    fixed: list[AppliedFix] = field(default_factory=list)
    unfixed: list[SkippedFinding] = field(default_factory=list)
    _latest: _State | None = None

    def make_safe_fixes(self, chart: int) -> None:
        """Make the safe fixes of a chart that cause no new finding: all fixes of a rule at once, or else one by one."""
        for player in range(max(len(self.song.charts[chart].players), 1)):
            for rule in fix_edits.RULES:
                fixes = [
                    fix for fix in self._safe_fixes(_chart_or_part(self.song, chart, player + 1)) if fix.rule == rule
                ]
                if fixes and not self._try(self._state(chart, player + 1), fixes):
                    for fix in fixes:
                        self._try(self._state(chart, player + 1), [fix])

    def fix(self, chart: int, finding: Finding, player: int = 0) -> None:
        """Remove one finding of a chart with the smallest edit that does so, or add the finding to `unfixed`.

        player : the player in whose part of a chart for two the finding is, else 0
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
        """Return the safe fixes of a chart as it is now.

        The grid is that of rule DT401 for this chart. If the rule is off, every tick is on the grid.
        """
        if is_lights(chart.steps_type):
            return []
        path = self.song.path.absolute()
        rules = self.settings.for_chart(path, chart.written_type, chart.difficulty, chart.meter)
        grid = rules[fix_edits.OFF_GRID]["grid"] if fix_edits.OFF_GRID in rules else [TICKS_PER_MEASURE]
        return fix_edits.safe_fixes(self.song.data, chart, [int(name) for name in grid])

    def _state(self, index: int, player: int = 0) -> _State:
        chart = _chart_or_part(self.song, index, player)
        if self._latest is None or self._latest.chart is not chart:
            self._latest = _check(self.song, chart, self.settings, self.preset_of(chart))
        return self._latest

    def _try(self, state: _State, fixes: Sequence[Fix], finding: Finding | None = None) -> bool:
        """Make fixes if the file then reads as intended, the finding is gone and no new finding appears."""
        splices = [splice for fix in fixes for splice in fix.splices]
        if len({splice.start for splice in splices}) < len(splices):
            return False
        after = check_edit(self.song, apply(self.song.data, splices), lambda one: one.index == state.chart.index)
        chart = _chart_or_part(after, state.chart.index, state.chart.player)
        if not _as_meant(state.chart, chart, fixes) or not _is_other_player_unchanged(state.chart, after, fixes):
            return False
        if finding is not None or not all(fix.is_silent for fix in fixes):
            new = _check(after, chart, self.settings, self.preset_of(chart))
            if not new.is_no_worse_than(state) or (finding and _count(new, finding) >= _count(state, finding)):
                return False
            self._latest = new
        self.song = after
        self.fixed += (AppliedFix(state.chart.label, fix, finding) for fix in fixes)
        return True


@dataclass(frozen=True, slots=True)
class _State:
    """A chart as it is now, with its findings."""

    chart: Chart
    subject: ChartSubject
    findings: tuple[Finding, ...]

    def is_no_worse_than(self, before: _State) -> bool:
        """Whether there is no finding that was not there before.

        Only the first few warnings of the reader are reported, so for those rules the number of findings counts.
        """
        return not _finding_counts(self.findings) - _finding_counts(before.findings)


def _check(song: Song, chart: Chart, settings: Settings, preset: Preset) -> _State:
    """Solve and check a chart."""
    subject = solved_chart(song, chart, preset)
    return _State(chart, subject, check_chart(subject, settings))


def _chart_or_part(song: Song, index: int, player: int) -> Chart:
    """Return a chart, or one player's part of a chart for two."""
    chart = song.charts[index]
    return chart.players[player - 1] if chart.players and player else chart


def _finding_counts(findings: Iterable[Finding]) -> Counter[tuple[str, float | None]]:
    """Return the number of findings of each rule and beat.

    Left out are rules that report only the worst place of a chart: a fix of that place makes another one the worst.
    For the rules of the reader all beats count together, see `_State.is_no_worse_than`.
    """
    return Counter(
        (one.rule, None if issubclass(all_rules()[one.rule], ReaderRule) else one.beat)
        for one in findings
        if not all_rules()[one.rule].only_worst
    )


def _count(state: _State, finding: Finding) -> int:
    """Return how many findings have the rule and the place of a finding."""
    place = (finding.rule, finding.line, finding.beat)
    return sum((one.rule, one.line, one.beat) == place for one in state.findings)


def _is_other_player_unchanged(before: Chart, after: Song, fixes: Sequence[Fix]) -> bool:
    """Whether the other player of a chart for two has the same notes as before, and none where a note moved to."""
    if before.written is None:
        return True
    places = {(tick, column + before.first_column) for fix in fixes for tick, column, _, _ in fix.new_notes}
    whole = before.written.notes
    mine = {(tick, column + before.first_column) for tick, column, _, _ in notes_of(before.notes)}
    others = set(zip(whole.tick.tolist(), whole.column.tolist(), strict=True)) - mine
    return not places & others and all(
        len(part.notes) + len(before.notes) == sum(len(one.notes) for one in after.charts[before.index].players)
        for part in after.charts[before.index].players
        if part.player != before.player
    )


def _as_meant(before: Chart, after: Chart, fixes: Sequence[Fix]) -> bool:
    """Whether a chart reads as the chart before with these fixes, note by note, and everything else is unchanged."""
    old = frozenset(note for fix in fixes for note in fix.old_notes)
    new = frozenset(note for fix in fixes for note in fix.new_notes)
    same = ("steps_type", "difficulty", "meter", "description", "columns", "timing", "tags", "notes_span")
    notes = notes_of(before.notes)
    return (
        old <= notes
        and not new & (notes - old)
        and notes_of(after.notes) == (notes - old) | new
        and all(getattr(before, name) == getattr(after, name) for name in same)
        and bool((before.rows.tick == after.rows.tick).all())
    )
