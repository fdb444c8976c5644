"""action.yml and .pre-commit-hooks.yaml: their commands are run as GitHub and pre-commit run them."""

from __future__ import annotations

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml

ROOT = Path(__file__).resolve().parent.parent.parent
SCRIPTS = Path(sys.executable).parent
ACTION: dict[str, Any] = yaml.safe_load((ROOT / "action.yml").read_text("utf-8"))
HOOKS: list[dict[str, Any]] = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text("utf-8"))
WALK = "#TITLE:T;\n#ARTIST:A;\n#CREDIT:C;\n#BPMS:0=120;\n#NOTES:dance-single:C:Hard:9::\n1000\n0100\n0010\n0001\n;\n"
FIVE = WALK.replace("dance-single", "dance-double").replace("1000\n0100\n0010\n0001", "11111111\n")
BASH = shutil.which("bash")


@pytest.fixture
def charts(tmp_path: Path) -> Path:
    """A repository of charts; its folder has a blank in its name."""
    for name, text in (("good one", WALK), ("bad", FIVE)):
        (tmp_path / "Songs" / name).mkdir(parents=True)
        (tmp_path / "Songs" / name / "x.sm").write_text(text)
    return tmp_path


def resolved(text: str, inputs: dict[str, str], folder: Path) -> str:
    """What GitHub puts in place of ${{ ... }}."""
    known = {f"inputs.{name}": value for name, value in inputs.items()}
    known |= {"github.action_path": str(ROOT), "runner.temp": str(folder / "temp"), "runner.os": "Linux"}
    return re.sub(r"\$\{\{\s*(\S+)\s*\}\}", lambda match: known[match[1]], text)


def run_step(step: dict[str, Any], folder: Path, path: str = "", **given: str) -> subprocess.CompletedProcess[str]:
    """Run one step of the action with GitHub's own shell line."""
    if BASH is None or os.name == "nt":
        pytest.skip("no bash here")
    inputs = {name: str(one["default"]) for name, one in ACTION["inputs"].items()} | given
    (folder / "temp").mkdir(exist_ok=True)
    script = folder / "step.sh"
    script.write_text(step["run"])
    environment = {key: resolved(str(value), inputs, folder) for key, value in step.get("env", {}).items()}
    environment |= {"RUNNER_TEMP": str(folder / "temp"), "GITHUB_OUTPUT": str(folder / "output")}
    environment |= {"PATH": f"{path}{os.pathsep}{SCRIPTS}{os.pathsep}{os.environ['PATH']}"}
    command = [BASH, "--noprofile", "--norc", "-eo", "pipefail", str(script)]
    working = resolved(step.get("working-directory", str(folder)), inputs, folder)
    return subprocess.run(
        command, cwd=working, env=os.environ | environment, capture_output=True, text=True, timeout=300
    )


def step_named(name: str) -> dict[str, Any]:
    return next(step for step in ACTION["runs"]["steps"] if step.get("name") == name)


def test_the_action_annotates_findings_and_fails(charts: Path) -> None:
    result = run_step(step_named("Analyze"), charts)
    assert result.returncode == 1, result.stderr
    assert "::error file=Songs/bad/x.sm,line=6,col=1,title=DT301 unplayable::" in result.stdout
    assert result.stdout.splitlines()[-1].startswith("2 files, 2 charts: 1 error")


def test_paths_stand_one_a_line_and_arguments_are_words(charts: Path) -> None:
    step = step_named("Analyze")
    assert run_step(step, charts, paths="Songs/good one").returncode == 0
    both = run_step(step, charts, paths="Songs/good one\nSongs/bad\n", arguments="--ignore DT301 --select DT3")
    assert both.returncode == 0 and "2 files" in both.stdout
    missing = run_step(step, charts, paths="Songs/nowhere.sm")
    assert missing.returncode == 2


def test_the_action_writes_sarif_where_its_output_says(charts: Path) -> None:
    result = run_step(step_named("Analyze"), charts, format="sarif")
    assert result.returncode == 1 and result.stdout == ""
    name, _, report = (charts / "output").read_text().strip().partition("=")
    assert name in ACTION["outputs"] and f"steps.{step_named('Analyze')['id']}.outputs.{name}" in str(ACTION["outputs"])
    log = json.loads(Path(report).read_text("utf-8"))
    assert [r["ruleId"] for r in log["runs"][0]["results"] if r["level"] == "error"] == ["DT301"]


def test_the_action_installs_itself_by_its_locks(charts: Path, tmp_path: Path) -> None:
    fake = tmp_path / "bin" / "python"
    fake.parent.mkdir()
    fake.write_text('#!/bin/sh\nprintf "%s " "$@" >> "$SEEN"\necho >> "$SEEN"\n')
    fake.chmod(0o755)
    step = {**step_named("Install"), "env": {**step_named("Install")["env"], "SEEN": str(tmp_path / "seen")}}
    assert run_step(step, charts, path=str(fake.parent)).returncode == 0
    locks = f"-r {ROOT}/requirements.lock -r {ROOT}/requirements-build.lock"
    assert (tmp_path / "seen").read_text().splitlines() == [
        f"-I -m pip install --quiet --require-hashes {locks} ",
        f"-I -m pip install --quiet --no-deps --no-build-isolation {ROOT} ",
    ]


def test_the_build_lock_is_part_of_the_lock_for_development() -> None:
    build, dev = ((ROOT / f"requirements-{name}.lock").read_text() for name in ("build", "dev"))
    packages = re.findall(r"^\S+==.*(?:\n[ \t]+.*)*\n", build, re.MULTILINE)
    assert "".join(packages) == build and packages[0].startswith("hatchling==")
    assert all(package in dev for package in packages)


def steps_of(document: dict[str, Any]) -> list[dict[str, Any]]:
    """The steps of an action or of all jobs of a workflow."""
    if "runs" in document:
        return list(document["runs"]["steps"])
    return [step for job in document["jobs"].values() for step in job["steps"]]


@pytest.mark.parametrize("name", ["action.yml", ".github/workflows/ci.yml"])
def test_nothing_of_a_checkout_is_run_in_place_of_pip(name: str) -> None:
    text = (ROOT / name).read_text("utf-8")
    document = yaml.safe_load(text)
    for step in steps_of(document):
        if uses := step.get("uses"):
            assert re.fullmatch(r"[\w-]+/[\w-]+@[0-9a-f]{40}", uses), uses
            assert re.search(rf"{re.escape(uses)}  # v\d+\.\d+\.\d+$", text, re.MULTILINE)  # for people
        run = step.get("run", "")
        assert not re.search(r"\bpython3?\s+(?!-I\b)", run)
        assert not re.search(r"(^|[\s;&|])pip3?\s", run.replace("-m pip", ""))
        if "pip install" in run:
            assert step.get("working-directory") == "${{ runner.temp }}"
            lines = [line for line in run.splitlines() if "pip install" in line]
            assert all("--require-hashes" in line or "--no-deps" in line for line in lines)
            isolated = [line for line in lines if "--no-deps" in line and "--no-index" not in line]
            assert all("--no-build-isolation" in line for line in isolated)
    if "jobs" in document:
        assert document["permissions"] == {"contents": "read"}
        assert not any("permissions" in job for job in document["jobs"].values())


def test_the_action_is_a_composite_one_github_can_read() -> None:
    assert {"name", "description", "inputs", "outputs", "runs"} <= set(ACTION)
    assert ACTION["runs"]["using"] == "composite"
    for step in ACTION["runs"]["steps"]:
        assert ("uses" in step) != ("run" in step)
        assert "run" not in step or step["shell"] == "bash"
    used = set(re.findall(r"inputs\.([\w-]+)", (ROOT / "action.yml").read_text("utf-8")))
    assert used == set(ACTION["inputs"])


@pytest.mark.parametrize("hook", HOOKS, ids=lambda hook: str(hook["id"]))
def test_hooks_take_the_files_that_pre_commit_gives(hook: dict[str, Any], charts: Path) -> None:
    assert {"id", "name", "entry", "language", "files"} <= set(hook) and hook["language"] == "python"
    for name, taken in (("a/x.sm", True), ("X.SSC", True), ("x.ucs", True), ("x.smx", False), ("x.sm.old", False)):
        assert bool(re.search(hook["files"], name)) == taken
    program, *words = shlex.split(hook["entry"])
    program = str(SCRIPTS / (f"{program}.exe" if os.name == "nt" else program))
    found = subprocess.run([program, *words, "Songs/bad/x.sm", "Songs/good one/x.sm"], cwd=charts, capture_output=True)
    assert found.returncode == 1
    if hook["id"] == "dancetutor":
        passed = subprocess.run([program, *words, "Songs/good one/x.sm"], cwd=charts, capture_output=True)
        assert passed.returncode == 0
