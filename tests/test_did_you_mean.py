"""Slips of the keyboard: the message names what was meant, if anything is near."""

from __future__ import annotations

import pytest

from dancetutor_cli.__main__ import main
from dancetutor_cli.run.errors import did_you_mean
from dancetutor_cli.run.reading import charts_path

DEMO = str(charts_path() / "two_left_feet" / "two_left_feet.ssc")
FILM = ("render", DEMO, "--index", "3", "--section", "4:5")


@pytest.mark.parametrize(
    ("arguments", "near", "also"),
    [
        (("analyse", DEMO), "analyze", "annotate"),
        (("ANALYZE", DEMO), "analyze", "annotate"),
        (("rendre",), "render", "warmup"),
        (("annotate", DEMO, "--style", "mesure", "--dry-run"), "measure", "sidecar"),
        (("annotate", DEMO, "--preset", "stamia", "--dry-run"), "stamina", "thesis"),
        ((*FILM, "--layout", "vertcal"), "vertical", "practice"),
        ((*FILM, "--camera", "tree-quarter"), "three-quarter", "back"),
        ((*FILM, "--character", "manequin"), "mannequin", "dancer"),
    ],
)
def test_the_nearest_name_is_proposed(
    capsys: pytest.CaptureFixture[str], arguments: tuple[str, ...], near: str, also: str
) -> None:
    with pytest.raises(SystemExit) as stop:
        main(arguments)
    assert stop.value.code == 2
    said = capsys.readouterr().err
    assert f"(did you mean {near}?)" in said
    assert also in said, "what else there is"


def test_nothing_is_proposed_for_what_is_far(capsys: pytest.CaptureFixture[str]) -> None:
    assert did_you_mean("gpt", ("itg", "thesis")) == ""
    assert did_you_mean("", ("itg",)) == ""
    with pytest.raises(SystemExit):
        main(["qqq"])
    said = capsys.readouterr().err
    assert "there is no command 'qqq'; choose analyze, annotate" in said
    assert "did you mean" not in said
