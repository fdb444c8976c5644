"""The sync of a pack, and `--config release` on a pack that is ready and on one that is not."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner
from PIL import Image
from synthetic import song

from dancetutor_cli.commands.analyze import command
from dancetutor_cli.lint.check import PackSyncs
from dancetutor_cli.lint.configuration import load_configuration
from dancetutor_cli.lint.findings import sync_of
from dancetutor_cli.lint.results import FileResult

NULL, ITG, OTHER = 0.5, 9.5, 25.0


def found(folder: Path, biases: dict[str, float], ini: str | None = None, confidence: float = 1.0) -> dict[str, str]:
    """Rule -> message for a pack of songs with these biases."""
    folder.mkdir(exist_ok=True)
    if ini is not None:
        (folder / "Pack.ini").write_text(f"[Group]\nVersion=1\nSyncOffset={ini}\n")
    packs = PackSyncs()
    for name, bias in biases.items():
        result = FileResult(str(folder / name / "s.ssc"), name, "", None, (), (), ())
        packs.add(replace(result, sync=sync_of(bias, confidence, 0.0, 500.0)))
    results = [packs.result(one, load_configuration(None).settings) for one in packs.folders]
    return {finding.rule: finding.message for result in results if result for finding in result.findings}


def test_a_pack_that_mixes_both_names_the_rarer(tmp_path: Path) -> None:
    said = found(tmp_path, {"A": NULL, "B": NULL, "C": ITG, "D": OTHER})
    assert said == {"DT604": "2 songs use null sync, 1 song uses ITG sync: C"}
    assert found(tmp_path, {"A": NULL, "B": NULL, "D": OTHER}) == {}
    assert found(tmp_path, {"A": NULL, "B": ITG}, confidence=0.5) == {}, "songs that are not sure do not count"


def test_a_song_that_drifts_is_of_neither_kind(tmp_path: Path) -> None:
    packs = PackSyncs()
    for name, bias, drift in (("A", NULL, 0.0), ("B", NULL, 0.0), ("C", ITG, 11.0)):
        result = FileResult(str(tmp_path / name / "s.ssc"), name, "", None, (), (), ())
        packs.add(replace(result, sync=sync_of(bias, 1.0, drift, 500.0)))
    assert [packs.result(one, load_configuration(None).settings) for one in packs.folders] == [None]


@pytest.mark.parametrize(("ini", "bias", "fires"), [
    ("ITG", NULL, True), ("NULL", ITG, True), ("NULL", NULL, False), ("itg", ITG, False), ("0.009", NULL, False),
])  # fmt: skip
def test_pack_ini_says_otherwise(tmp_path: Path, ini: str, bias: float, fires: bool) -> None:
    assert ("DT605" in found(tmp_path, {"A": bias, "B": bias, "C": bias}, ini)) == fires


def test_one_song_is_no_pack_and_a_pair_is_one_song(tmp_path: Path) -> None:
    packs = PackSyncs()
    for name, bias in (("s.sm", ITG), ("s.ssc", NULL)):
        result = FileResult(str(tmp_path / "A" / name), "A", "", None, (), (), ())
        packs.add(replace(result, sync=sync_of(bias, 1.0, 0.0, 500.0)))
    assert list(packs.folders) == []


def pack(folder: Path, offsets: tuple[float, float]) -> Path:
    """Two songs of which an organiser has nothing to say but, perhaps, the sync."""
    dear = "#CREDIT:C;\n#BANNER:bn.png;\n#BACKGROUND:bg.png;\n#SAMPLESTART:5;\n#SAMPLELENGTH:10;\n"
    for seed, offset in zip((2011, 2012), offsets, strict=True):
        path = song(seed, seconds=30).write(folder / f"Song {seed}", offset_ms=offset, more=dear)
        Image.new("RGB", (418, 164)).save(path.parent / "bn.png")
        Image.new("RGB", (640, 480)).save(path.parent / "bg.png")
    (folder / "Pack.ini").write_text("[Group]\nVersion=1\nSyncOffset=NULL\n")
    return folder


def released(folder: Path, *options: str) -> tuple[int, list[dict[str, object]]]:
    # Charts made of dice have feet that no release has; what a stepartist answers for is not the matter here.
    words = [str(folder), "--config", "release", "--format", "jsonl", "--no-cache", "--ignore", "DT2,DT3,length"]
    said = CliRunner().invoke(command, [*words, *options], standalone_mode=False)
    return said.return_value, [json.loads(line) for line in said.stdout.splitlines()]


def test_a_pack_that_is_ready_says_nothing(tmp_path: Path) -> None:
    assert released(pack(tmp_path / "Songs" / "Pack", (0.0, 0.0))) == (0, [])


def test_a_pack_that_is_not_ready_says_why(tmp_path: Path) -> None:
    folder = pack(tmp_path / "Songs" / "Pack", (9.0, -25.0))
    (folder / "Song 2012" / "bn.png").unlink()
    status, said = released(folder)
    rules = {str(one["rule"]) for one in said}
    assert status == 1 and rules == {"DT504", "DT601"}
    assert released(folder, "--set", "sync=false")[1][0]["rule"] == "DT504"


def test_two_charts_of_one_meter_are_an_authors_own_matter(tmp_path: Path) -> None:
    folder = pack(tmp_path / "Songs" / "Pack", (0.0, 0.0))
    path = next(folder.glob("Song 2011/*.s*m*"))
    notes = "#NOTES:dance-single:C:{}:{}::\n0000\n1000\n0100\n0001\n;\n"
    first = path.read_text(encoding="utf-8").partition("#NOTES")[0]
    path.write_text(first + notes.format("Easy", 5) + notes.format("Medium", 5).replace("1000", "0010"))
    assert "DT503" not in {one["rule"] for one in released(folder)[1]}
    path.write_text(first + notes.format("Easy", 5) + notes.format("Medium", 4).replace("1000", "0010"))
    assert "DT503" in {one["rule"] for one in released(folder)[1]}


def test_a_mixed_pack_has_a_result_of_its_own(tmp_path: Path) -> None:
    folder = pack(tmp_path / "Songs" / "Pack", (0.0, 9.0))
    (folder / "Pack.ini").write_text("[Group]\nVersion=1\nSyncOffset=ITG\n")
    status, said = released(folder)
    assert status == 1 and [(one["rule"], Path(str(one["path"])).name) for one in said] == [("DT604", "Pack")]


def test_the_release_preset_says_of_every_line_what_it_is_for() -> None:
    names = load_configuration("release")
    assert names.settings.sync
    running = set(names.settings.for_file(Path("x.ssc")))
    assert {"DT112", "DT113", "DT114", "DT115", "DT504", "DT505", "DT511", "DT513", "DT514"} <= running
    assert {f"DT{number}" for number in range(601, 612)} <= running
    assert not {"DT207", "DT213", "DT304", "DT401", "DT509"} & running
