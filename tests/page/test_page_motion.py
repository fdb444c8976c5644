"""The motion in the page: where its own script draws the joints, against the motion that was baked."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from dancetutor_cli.character.onto_skeleton import onto
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.page import work

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = """
import { readFileSync } from "node:fs";
const { unpack } = await import(process.argv[1] + "/blob.js");
const { Motion } = await import(process.argv[1] + "/motion.js");
const { doc, arrays } = await unpack(readFileSync(process.argv[2], "latin1"));
const motion = new Motion(doc.motions[0], arrays, doc.body);
const pose = motion.pose();
const out = JSON.parse(readFileSync(process.argv[3], "utf8")).map((second) => {
  motion.sample(second, pose);
  motion.forward(pose);
  return [...pose.place];
});
console.log(JSON.stringify(out));
"""
# Chosen on the stream of `tools/bench_growth.py`; these two are others: the demo's hard chart, and one with hands.
CHARTS = [
    (ROOT / "charts" / "two_left_feet" / "two_left_feet.ssc", Selection(difficulty="challenge")),
    (None, Selection()),
]
HANDS = "#TITLE:Hands;\n#BPMS:0=150;\n#NOTES:dance-single::Hard:9::\n{notes}\n;\n"


@pytest.mark.parametrize("which", [0, 1], ids=["demo", "hands"])
def test_joints_are_drawn_where_they_were_baked(which: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Feet that stand within 2 mm at almost all keys, all joints within what nobody sees from where the camera is."""
    node = shutil.which("node")
    if node is None:
        pytest.skip("no Node here; Debian/Ubuntu: apt-get install nodejs")
    path, selection = CHARTS[which]
    if path is None:
        path = tmp_path / "hands.sm"
        path.write_text(HANDS.format(notes="\n,\n".join(["1000\n0100\n0010\n0001\n1101\n0000\n1000\n0001"] * 8)))
    kept: list[Motion] = []
    real = onto
    monkeypatch.setattr("dancetutor_cli.character.onto_skeleton.onto", lambda *a: kept.append(real(*a)) or kept[-1])
    page = work.make_page(work.PageRequest(DanceRequest(path, selection)))
    data = re.search(rb'id="data">([^<]*)<', page.html)
    assert data and kept
    (tmp_path / "data").write_bytes(data[1])
    motion = kept[0]
    choice = np.linspace(0, len(motion.times) - 1, 3000).astype(int)
    (tmp_path / "times").write_text(json.dumps(motion.times[choice].tolist()))
    command = [node, "--input-type=module", "-e", SCRIPT, str(ROOT / "dancetutor_cli/page/js")]
    done = subprocess.run(
        [*command, str(tmp_path / "data"), str(tmp_path / "times")], capture_output=True, text=True, check=True
    )
    drawn = np.array(json.loads(done.stdout)).reshape(len(choice), -1, 3)
    names = motion.skeleton.names
    baked, _ = world_transforms(motion.skeleton, motion.rotations[choice], motion.root[choice])
    off = np.linalg.norm(drawn[:, : len(names)] - baked, axis=-1) * 1000  # millimetres
    for limb, side in enumerate("lr"):
        stands = np.zeros(len(motion.times), dtype=bool)
        for contact in motion.contacts:
            if contact.limb == limb:
                stands[slice(*np.searchsorted(motion.times, (contact.start, contact.end)))] = True
        foot = off[:, names.index(f"{side}_metatarsal")]
        assert stands[choice].any() and np.percentile(foot[stands[choice]], 99) < 2.0
        assert np.percentile(foot, 99) < 6.0
    assert np.median(off) < 1.5 and np.percentile(off, 99) < 8.0
