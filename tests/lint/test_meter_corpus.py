"""The shipped models on real charts: near their labels, and never easier faster. How far songs not seen are missed is
measured by research/fit_meter.py, see docs/meter.md; this notices if the program and the models grow apart."""

from __future__ import annotations

import shutil
import sys
from collections import defaultdict
from pathlib import Path

import numpy as np

from dancetutor_cli.lint.meter.estimate import measure_chart, on_scale, scales_of
from dancetutor_cli.lint.meter.model import model_for

sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "research"))
from meter_data import Labelled, labelled, sorted_out


def test_real_charts_play_like_their_meters(corpus: Path, tmp_path: Path) -> None:
    model = model_for("dance-single")
    assert model is not None
    for path in sorted(corpus.rglob("*.s[ms]*"))[::9]:
        shutil.copy(path, tmp_path / path.name)
    charts = [one for one in labelled(tmp_path, model.features) if one.steps_type == "dance-single"]
    by_file: dict[str, list[Labelled]] = defaultdict(list)
    for one, reason in sorted_out(charts):
        if not reason:
            by_file[one.file].append(one)
    misses, inside = [], []
    for of_file in by_file.values():
        found = [measure_chart(model, one.values, (one.meter, one.difficulty)) for one in of_file]
        for one, this, (scale, known) in zip(of_file, found, scales_of(found, of_file[0].tag), strict=True):
            if known:
                told = on_scale(this, scale, known)
                misses.append(abs(told.meter - one.meter))
                inside.append(told.low <= one.meter <= told.high)
    assert len(misses) > 80
    assert np.mean(misses) < 0.8
    assert 0.7 < np.mean(inside) < 0.95
