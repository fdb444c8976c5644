"""The thesis restaged: page and pictures are what the command makes of its figures, and the figures are still true."""

import json
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

sys.path.insert(0, str(Path(__file__).parent.parent / "tools"))
import thesis_restaged as tool

SETTINGS = (
    "no limits", "no extra points", "no stiffness", "60 steps, 30 samples", "center", "hybrid", "friction 8", "density",
    "gravity 4", "no knee points", "no point on top of the head", "left wrist alone",
)  # fmt: skip
DATA = json.loads(tool.DATA.read_text())


def test_the_page_is_what_the_command_writes() -> None:
    text = tool.PAGE.read_text(encoding="utf-8")
    assert tool.page_with(text, tool.block(DATA)) == text, "run tools/thesis_restaged.py FOLDER"
    for name, picture in tool.pictures(DATA).items():
        assert (tool.PAGE.parent / name).read_text(encoding="utf-8") == picture, name
        root = ElementTree.fromstring(picture)
        curves = [one for one in root.iter() if one.tag.endswith("polyline")]
        assert 2 <= len(curves) <= 8 and f"]({name})" in text


def test_every_setting_of_the_thesis_is_there() -> None:
    words = tool.block(DATA)
    for setting in SETTINGS:
        assert setting in words
    rows = {row["words"]: row["figures"] for key in DATA for row in DATA[key] if "figures" in row}
    assert rows["no knee points, no limits"][0] < -45 < -10 <= rows["no knee points, limits"][0], "limits keep the knee"
    assert rows["no stiffness, no extra points"][0] > 2 * rows["stiffness, extra points"][0]
    assert rows["no extra points"][0] > 10 * rows["extra points"][0]
    assert rows["center, 5 Hz"][4] > 3 * rows["end, 5 Hz"][4] and rows["hybrid, 5 Hz"][4] < rows["center, 5 Hz"][4] / 2
    assert rows["gravity 20"][0] < rows["gravity 4"][0] - 1.0 < rows["gravity 1 upward"][0] - 1.0
    assert rows["gravity 20; corrected"][0] < rows["nothing; corrected"][0] - 0.4, "it reaches the result of retarget"
    assert rows["density of head and arms 10,000"][4] > 4 * rows["nothing"][4]
    assert rows["friction 0, gravity 9.81"][6] > 1.3 * rows["friction 8, gravity 9.81"][6]


@pytest.mark.parametrize("key", ["rotation", "limits"])
def test_measured_again_they_are_the_same(shared_data: Path, key: str) -> None:
    walk = shared_data / "bvh" / "pymo_8walk.bvh"
    experiment = next(one for one in tool.experiments() if one.key == key)
    made = tool.measured(experiment, {walk.stem: tool.clip(walk)})
    for new, old in zip(made, DATA[key], strict=True):
        assert new["words"] == old["words"]
        assert new["figures"] == pytest.approx(old["figures"], rel=0.05, abs=0.1)
