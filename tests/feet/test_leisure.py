"""What people do where there is time: on dance pads a row of two arrows is then a jump, not a bracket."""

from pathlib import Path

import pytest

from dancetutor_cli.chart.reader import parse
from dancetutor_cli.feet.preset import Preset, load_preset
from dancetutor_cli.feet.solver.solve import solve_chart

# sixteenths at 90 BPM: 0.5 s before the pair and after it; the foot of one of its arrows has to leave the other's
PASSAGES = [
    "0001 0000 1000 0010 0100 0000 0000 0011 0000 0000 0010 1000 0100 0000 0010 0000",
    "0001 0000 1000 0001 0010 0000 0000 0101 0000 0000 0100 0010 0001 0000 1000 0000",
    "0010 0000 0100 0010 0100 0000 0000 1010 0000 0000 0010 0100 1000 0000 0010 0000",
    "0001 0000 0001 0010 0001 0000 0000 1010 0000 0000 0010 0001 0010 0000 1000 0000",
]


def feet_of_the_pair(passage: str, bpm: float, preset: Preset) -> set[int]:
    """The limbs that take the only row of two arrows."""
    notes = "\n".join(passage.split())
    text = f"#TITLE:T;\n#BPMS:0={bpm};\n#NOTES:dance-single::Easy:3::\n{notes}\n;\n"
    play = solve_chart(parse(text.encode(), Path("x.sm")).charts[0], preset)
    pair = (play.rows.steps > 0).sum(axis=1).tolist().index(2)
    return set(play.limb[pair][play.rows.steps[pair] > 0].tolist())


@pytest.mark.parametrize("passage", PASSAGES)
def test_two_arrows_at_leisure_are_a_jump(passage: str) -> None:
    assert feet_of_the_pair(passage, 90.0, load_preset("itg")) == {0, 1}
