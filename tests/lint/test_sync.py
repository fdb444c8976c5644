"""Beats against the audio, on songs that were made of known events, with seeds that nothing was tuned on."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from synthetic import SyntheticSong, song

from dancetutor_cli.chart.audio import Sound
from dancetutor_cli.chart.reader import parse
from dancetutor_cli.commands.analyze import command
from dancetutor_cli.lint.findings import Sync, sync_of
from dancetutor_cli.lint.song_sync import hear, song_sync
from dancetutor_cli.lint.sync import Judgement, Onsets, judge, onsets
from dancetutor_cli.run.errors import FileError

DEMO = Path(__file__).resolve().parent.parent.parent / "charts" / "two_left_feet" / "two_left_feet.sm"
SEEDS = range(2000, 2006)


@cache
def made(seed: int) -> tuple[SyntheticSong, Onsets]:
    one = song(seed)
    halved = one.music[: len(one.music) // 2 * 2].reshape(-1, 2).mean(axis=1).astype(np.float32)
    return one, onsets(Sound(halved, 22050))


def judged(text: str, heard: Onsets) -> Sync:
    read = parse(text.encode(), Path("song.sm"))
    found = judge(read.timing, read.charts, heard)
    return found.sync if isinstance(found, Judgement) else found


@pytest.mark.parametrize("seed", SEEDS)
def test_music_at_the_beats_is_null(seed: int) -> None:
    one, heard = made(seed)
    found = judged(one.text(), heard)
    assert found.kind == "null" and found.confidence >= 0.8 and not found.beat_off
    assert found.drift_ms is not None and abs(found.drift_ms) < 2


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("shift", [9, -9, 25, -60])
def test_a_shifted_file_is_reported(seed: int, shift: int) -> None:
    one, heard = made(seed)
    before, after = judged(one.text(), heard), judged(one.text(shift), heard)
    assert before.bias_ms is not None and after.bias_ms is not None
    assert after.confidence >= 0.8
    assert after.bias_ms - before.bias_ms == pytest.approx(shift, abs=1.5)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_wrong_tempo_is_a_drift(seed: int) -> None:
    one, heard = made(seed)
    found = judged(one.text(bpm=one.bpm * 1.0005), heard)
    read = parse(one.text().encode(), Path("song.sm"))
    ticks = np.concatenate([chart.notes.tick for chart in read.charts])
    span = float(np.ptp(read.timing.seconds(ticks)))
    assert found.drift_ms == pytest.approx((1 - 1 / 1.0005) * 2 / 3 * span * 1000, abs=2)


@pytest.mark.parametrize("seed", SEEDS)
def test_half_a_beat_is_off_or_not_sure(seed: int) -> None:
    """Which way cannot be told: half a beat late is half a beat early, a beat further on."""
    one, heard = made(seed)
    half = 30_000 / one.bpm
    for found in (judged(one.text(half), heard), judged(one.text(-half), heard)):
        assert found.bias_ms is not None
        assert found.confidence < 0.8 or (found.beat_off and abs(found.bias_ms) == pytest.approx(half, abs=6))


def test_half_a_beat_is_mostly_reported() -> None:
    songs = [made(seed) for seed in SEEDS]
    found = [judged(one.text(sign * 30_000 / one.bpm), heard) for one, heard in songs for sign in (1, -1)]
    assert sum(one.confidence >= 0.8 for one in found) >= 8  # of 12


@pytest.mark.parametrize("seed", SEEDS)
def test_other_music_is_not_trusted(seed: int) -> None:
    one, _ = made(seed)
    for other in SEEDS:
        if other != seed:
            assert judged(one.text(), made(other)[1]).kind == "unsure"


def test_what_cannot_be_judged_has_no_bias() -> None:
    one, heard = made(SEEDS[0])
    for text, why in (
        (one.text(more="#STOPS:8=-0.1;"), "warps or negative stops"),
        (one.text(bpm=4000), "BPMs over 1000"),
        (one.text(-500_000), "outside the music"),
        ("#TITLE:T;\n#BPMS:0=120;\n#NOTES:dance-single::Hard:5::1000\n0100\n;", "too few notes"),
    ):
        found = judged(text, heard)
        assert (found.bias_ms, found.kind) == (None, "unsure")
        assert why in str(found.reason)


def test_silence_and_noise_are_not_sure() -> None:
    one, _ = made(SEEDS[0])
    for samples in (np.zeros(22050 * 43), np.random.default_rng(1).standard_normal(22050 * 43) / 10):
        assert judged(one.text(), onsets(Sound(samples.astype(np.float32), 22050))).kind == "unsure"


def test_kinds_have_three_milliseconds_of_tolerance() -> None:
    kinds = {bias: sync_of(bias, 1.0, 0.0, 500.0).kind for bias in (-3.1, -3.0, 3.0, 3.1, 6.0, 12.0, 12.1)}
    assert list(kinds.values()) == ["other", "null", "null", "other", "itg", "itg", "other"]
    assert sync_of(0.0, 0.79, 0.0, 500.0).kind == "unsure"
    assert [sync_of(bias, 1.0, 0.0, 500.0).beat_off for bias in (125.0, 126.0, -126.0)] == [False, True, True]


def test_charts_with_timing_of_their_own_are_judged_apart(tmp_path: Path) -> None:
    one = song(SEEDS[1])
    path = one.write(tmp_path)
    notes = one.text().split("#NOTES:")[1].split("::\n")[1]
    own = f"#OFFSET:{0.025 - one.lead:.6f};#BPMS:0={one.bpm:.6f};"
    chart = "#NOTEDATA:;#STEPSTYPE:dance-single;#DIFFICULTY:{};#METER:5;{}#NOTES:{}\n"
    hard = one.text().split("#NOTES:")[3].split("::\n")[1]
    text = one.text().split("#NOTES")[0] + chart.format("Hard", "", hard) + chart.format("Challenge", own, hard)
    ssc = path.with_suffix(".ssc")
    ssc.write_text("#VERSION:0.83;\n" + text + chart.format("Easy", "", notes), encoding="utf-8")
    found = song_sync(parse(ssc.read_bytes(), ssc))
    assert found.sync.kind == "null" and list(found.of_charts) == [1]
    other = found.of_charts[1]
    assert other.bias_ms is not None and found.sync.bias_ms is not None
    assert other.bias_ms - found.sync.bias_ms == pytest.approx(25, abs=1.5)


def test_missing_and_damaged_music_is_unsure(tmp_path: Path) -> None:
    path = song(SEEDS[0], seconds=15).write(tmp_path)
    good = (tmp_path / "song.wav").read_bytes()
    for content in (b"", good[:30], good[:2000], b"RIFF" + bytes(100)):
        (tmp_path / "song.wav").write_bytes(content)
        assert song_sync(parse(path.read_bytes(), path)).sync.kind == "unsure"
    (tmp_path / "song.wav").unlink()
    assert "not there" in str(song_sync(parse(path.read_bytes(), path)).sync.reason)
    with pytest.raises(FileError):
        hear(tmp_path / "song.wav")


def test_json_reports_the_sync_only_where_it_was_asked_for(tmp_path: Path) -> None:
    path = song(SEEDS[2]).write(tmp_path, offset_ms=25)
    runner = CliRunner()
    plain = json.loads(runner.invoke(command, [str(path), "--format", "json", "--no-cache", "--exit-zero"]).output)
    assert "sync" not in plain["files"][0]
    said = runner.invoke(command, [str(path), "--sync", "--format", "json", "--no-cache", "--exit-zero"])
    found = json.loads(said.stdout)["files"][0]
    assert set(found["sync"]) == {"bias_ms", "confidence", "drift_ms", "beat_off", "kind"}
    assert found["sync"]["bias_ms"] == pytest.approx(25, abs=3) and found["sync"]["kind"] == "other"
    assert [one["rule"] for one in found["findings"] if one["rule"].startswith("DT60")] == ["DT601"]


def test_results_are_kept_with_their_sync_until_the_music_changes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DANCETUTOR_CACHE", str(tmp_path / "cache"))
    path = song(SEEDS[2]).write(tmp_path / "song")
    words = [str(path), "--sync", "--full", "--exit-zero"]
    first, plain = CliRunner().invoke(command, words).stdout, CliRunner().invoke(command, words[:1] + words[2:]).stdout
    assert "sync: null (music " in first and "sync:" not in plain
    with monkeypatch.context() as patch:
        patch.setattr("dancetutor_cli.lint.song_sync.song_sync", None)  # nobody hears it again
        assert CliRunner().invoke(command, words).stdout == first
    (path.parent / "song.wav").write_bytes(b"")
    assert "sync: cannot be judged: its music song.wav is empty" in CliRunner().invoke(command, words).stdout


def test_a_plot_is_one_picture_of_one_file(tmp_path: Path) -> None:
    path = song(SEEDS[2]).write(tmp_path / "song")
    picture = tmp_path / "bias.svg"
    said = CliRunner().invoke(command, [str(path), "--sync", "--plot", str(picture), "--no-cache", "--exit-zero"])
    assert said.exit_code == 0 and "a diagram of the sync over the song" in said.stderr
    text = picture.read_text(encoding="utf-8")
    assert text.startswith("<svg") and text.count("<circle") >= 24 and "http:" not in text.replace("http://www.w3", "")


def test_a_plot_without_a_sync_is_refused(tmp_path: Path) -> None:
    said = CliRunner().invoke(command, [str(DEMO), "--plot", str(tmp_path / "x.svg")])
    assert "add --sync" in str(said.exception)


def test_the_demo_song_is_null() -> None:
    found = song_sync(parse(DEMO.read_bytes(), DEMO)).sync
    assert found.kind == "null" and not found.beat_off


def test_real_songs_are_null(shared_data: Path) -> None:
    path = next((shared_data / "songs" / "goin_under").glob("*.sm"))
    assert song_sync(parse(path.read_bytes(), path)).sync.kind == "null"
