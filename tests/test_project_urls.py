"""The metadata's URLs: the checkout's own home, told by the workflow or by git, and nothing made up."""

import re
import subprocess
from pathlib import Path
from types import ModuleType

import pytest
from module_file import loaded

pytest.importorskip("hatchling", reason="hatchling builds the package; pip install -e .[dev] brings it")


@pytest.fixture
def tool(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """tools/project_urls.py, as hatchling loads it, in no workflow."""
    monkeypatch.delenv("GITHUB_SERVER_URL", raising=False)
    monkeypatch.delenv("GITHUB_REPOSITORY", raising=False)
    path = Path(__file__).parents[1] / "tools" / "project_urls.py"
    return loaded(path)


@pytest.mark.parametrize(
    ("remote", "web"),
    [
        ("https://github.com/ann/dancetutor.git", "https://github.com/ann/dancetutor"),
        ("https://user:secret@codeberg.org/ann/dancetutor", "https://codeberg.org/ann/dancetutor"),
        ("git@github.com:ann/dancetutor.git", "https://github.com/ann/dancetutor"),
        ("ssh://git@gitlab.com:2222/group/sub/dancetutor.git/", "https://gitlab.com/group/sub/dancetutor"),
        ("/srv/git/dancetutor", None),
        ("file:///srv/git/dancetutor", None),
        (r"C:\work\dancetutor", None),
        ("http://localhost/ann/dancetutor", None),
        ("", None),
    ],
)
def test_a_remote_as_a_web_address(tool: ModuleType, remote: str, web: str | None) -> None:
    assert tool.address(remote) == web


def test_the_remote_of_a_checkout_and_the_workflow_before_it(
    tool: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert tool.urls(tmp_path) == {}
    subprocess.run(["git", "init", "-q", str(tmp_path)], check=True)
    assert tool.urls(tmp_path) == {}
    remote = ["git", "-C", str(tmp_path), "remote", "add", "origin", "git@example.org:ann/dancetutor.git"]
    subprocess.run(remote, check=True)
    assert tool.urls(tmp_path)["Issues"] == "https://example.org/ann/dancetutor/issues"
    monkeypatch.setenv("GITHUB_SERVER_URL", "https://github.com")
    monkeypatch.setenv("GITHUB_REPOSITORY", "bob/fork")
    monkeypatch.setenv("GITHUB_WORKSPACE", str(tmp_path.parent))  # which installs it from elsewhere
    assert tool.urls(tmp_path)["Homepage"] == "https://example.org/ann/dancetutor"
    monkeypatch.setenv("GITHUB_WORKSPACE", str(tmp_path))
    assert tool.urls(tmp_path)["Homepage"] == "https://github.com/bob/fork"


def test_a_wheel_from_an_sdist_keeps_its_addresses(tool: ModuleType, tmp_path: Path) -> None:
    text = (
        "Metadata-Version: 2.4\nName: dancetutor\nProject-URL: Source, https://example.org/a/b\n\nProject-URL: x, y\n"
    )
    (tmp_path / "PKG-INFO").write_text(text, encoding="utf-8")
    assert tool.urls(tmp_path) == {"Source": "https://example.org/a/b"}
    assert tool.description(tmp_path) == "Project-URL: x, y\n"


README = """# x
![A picture](.github/frame.png) [a page](docs/guide.md#top), [`code`](docs/meter.md),
[out](https://example.com/a), [here](#x)
"""


def test_links_of_the_description_are_absolute(
    tool: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "README.md").write_text(README, encoding="utf-8")
    monkeypatch.setattr(tool, "home", lambda root: "https://example.org/ann/x")
    said = tool.description(tmp_path)
    assert "![A picture](https://example.org/ann/x/raw/main/.github/frame.png)" in said
    assert "[a page](https://example.org/ann/x/blob/main/docs/guide.md#top)" in said
    assert "[out](https://example.com/a), [here](#x)" in said
    monkeypatch.setattr(tool, "home", lambda root: None)
    assert tool.description(tmp_path) == "# x\n a page, `code`,\n[out](https://example.com/a), [here](#x)\n"


def test_no_relative_link_is_left_in_the_readme(tool: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    root = Path(__file__).parents[1]
    if (root / "PKG-INFO").exists():
        pytest.skip("this is an unpacked sdist, whose description is made")
    for home in (None, "https://example.org/ann/x"):
        monkeypatch.setattr(tool, "home", lambda root, home=home: home)
        targets = re.findall(r"\]\(([^)]+)\)", tool.description(root))
        assert [target for target in targets if not target.startswith(("https://", "#"))] == []
        assert bool(targets) == (home is not None)
