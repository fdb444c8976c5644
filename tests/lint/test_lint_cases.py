"""The cases in cases/*.yml, run through the whole of `analyze`."""

from __future__ import annotations

import wave
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from numpy.typing import NDArray
from PIL import Image

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.feet.play import Play
from dancetutor_cli.feet.preset import PresetChoice, load_preset
from dancetutor_cli.feet.solver import solve
from dancetutor_cli.lint import song_sync
from dancetutor_cli.lint.analysis import AnalyzeTask, analyze_file
from dancetutor_cli.lint.configuration import load_configuration, with_assignments, with_selection
from dancetutor_cli.lint.findings import sync_of
from dancetutor_cli.lint.rule import PackRule, all_rules
from dancetutor_cli.lint.sync import Onsets

CASES = Path(__file__).parent / "cases"
KNOWN = {"rows", "pin", "notes", "steps-type", "description", "difficulty", "meter", "bpms", "tags",
         "files", "analyse", "preset", "confidence", "options", "found", "says", "severity", "music",
         "sync", "pictures", "folder"}  # fmt: skip


def load(path: Path) -> dict[str, Any]:
    # Rows such as 0100 must not become numbers: everything is read as text, and lists of beats are made numbers below.
    found: dict[str, Any] = yaml.load(path.read_text("utf-8"), Loader=yaml.BaseLoader)
    return found


def all_cases() -> list[Any]:
    found = []
    for path in sorted(CASES.glob("*.yml")):
        data = load(path)
        for name, case in data["cases"].items():
            shared = {key: data[key] for key in ("preset", "options") if key in data}
            found.append(pytest.param(path.stem, {**shared, **case}, id=f"{path.stem}-{name}"))
    return found


def chart_text(case: dict[str, Any]) -> str:
    tags = case.get("tags", "#TITLE:T;#ARTIST:A;#CREDIT:C;").replace(";", ";\n")
    notes = case["notes"] if "notes" in case else "\n".join(case["rows"])
    head = [
        case.get("steps-type", "dance-single"),
        case.get("description", "C"),
        case.get("difficulty", "Hard"),
        case.get("meter", "9"),
        "",
    ]
    return f"{tags}#BPMS:{case.get('bpms', '0=120')};\n#NOTES:{':'.join(head)}:{case.get('pin', '')}\n{notes}\n;\n"


@pytest.mark.parametrize(("code", "case"), all_cases())
def test_case(code: str, case: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert set(case) <= KNOWN
    if "confidence" in case:
        sure = np.array([float(one) for one in case["confidence"]]) / 100
        monkeypatch.setattr(solve, "solve_rows", _with(solve.solve_rows, sure))
    folder = tmp_path / case.get("folder", ".")
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in case.get("files", {}).items():
        (folder / name).write_text(content)
    for name, size in case.get("pictures", {}).items():
        Image.new("RGB", tuple(map(int, size.split("x")))).save(folder / name)
    for name, form in case.get("music", {}).items():
        write_wave(folder / name, *map(int, form.split()))
    if "sync" in case:
        monkeypatch.setattr(song_sync, "song_sync", lambda _: judged(**case["sync"]))
    path = folder / "case.sm"
    path.write_text(chart_text(case), encoding="utf-8")
    assignments = [f"{code}.severity=warning"]
    assignments += [f"{code}.{key}={_yaml(value)}" for key, value in case.get("options", {}).items()]
    assignments += ["sync=true"] if "sync" in case else []
    configuration = with_selection(with_assignments(load_configuration(None), assignments), [code], [])
    preset = load_preset(case.get("preset", "thesis"))
    path = folder / case.get("analyse", path.name)
    result = analyze_file(AnalyzeTask(path, PresetChoice(preset), Selection(), configuration.settings))
    assert result.error is None
    found = [finding for finding, _ in result.all_findings()]
    assert all(finding.rule == code for finding in found)
    places = ["file" if finding.beat is None else finding.beat for finding in found]
    expected = ["file" if beat == "file" else pytest.approx(float(beat), abs=1e-6) for beat in case["found"]]
    assert places == expected
    if "says" in case:
        assert case["says"] in found[0].message
    if "severity" in case:
        assert {finding.severity for finding in found} == {case["severity"]}


def write_wave(path: Path, seconds: int, rate: int, channels: int) -> None:
    with wave.open(str(path), "wb") as out:
        out.setnchannels(channels)
        out.setsampwidth(2)
        out.setframerate(rate)
        out.writeframes(bytes(2 * channels * rate * seconds))


def judged(
    bias: str = "0", confidence: str = "1", drift: str = "0", beat: str = "500", silence: str = "0", clipped: str = "0"
) -> song_sync.SongSync:
    heard = song_sync.Heard(Onsets(np.zeros(2, np.float32), 0.0, 1.0), float(silence), float(clipped))
    return song_sync.SongSync(sync_of(float(bias), float(confidence), float(drift), float(beat)), heard=heard)


def _with(solve: Callable[..., Play], sure: NDArray[np.float64]) -> Callable[..., Play]:
    return lambda *words, **named: replace(solve(*words, **named), confidence=sure)


def _yaml(value: Any) -> str:
    return f"[{', '.join(value)}]" if isinstance(value, list) else str(value)


def test_every_rule_has_failing_and_passing_cases() -> None:
    # A file that cannot be read has no case that can: see test_cli_analyze.py; rules of packs: see test_pack_sync.py.
    without = {"DT101", *(code for code, rule in all_rules().items() if issubclass(rule, PackRule))}
    for code in sorted(set(all_rules()) - without):
        path = CASES / f"{code}.yml"
        assert path.exists(), f"{code} has no cases"
        cases = load(path)["cases"].values()
        assert any(case["found"] for case in cases), f"{code} has no failing case"
        assert any(not case["found"] for case in cases), f"{code} has no passing case"
