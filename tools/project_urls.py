"""The project's URLs and description for the package's metadata: those of the repository that it is built from.

A checkout knows its home: the workflow whose checkout it is says so (`GITHUB_SERVER_URL`, `GITHUB_REPOSITORY`), or its
git remote `origin` does. A fork's wheel so points to the fork, and never to a project whose workflow installs this one.
Where neither is known (an archive without git, a clone of a local folder) no address is made up; a wheel built from an
sdist keeps the sdist's. The description is README.md with its links made absolute, since it is read elsewhere; where
the home is not known, links are plain text and pictures are left out.
"""

import os
import re
import subprocess
from email.parser import HeaderParser
from pathlib import Path
from typing import Any

from hatchling.metadata.plugin.interface import MetadataHookInterface

# https://host/owner/name, ssh://git@host/owner/name, git@host:owner/name; a user or token before @ is left out
REMOTE = re.compile(
    r"(?:(?:https?|ssh|git)://(?:[^@/]+@)?(?P<host>[\w.-]+\.\w+)(?::\d+)?/|(?:[\w.-]+@)(?P<scp>[\w.-]+\.\w+):)"
    r"(?P<path>[\w.~-]+(?:/[\w.~-]+)+)"
)
# [text](target) or ![text](target), of targets inside the repository
LINK = re.compile(r"(?P<picture>!?)\[(?P<text>[^\]]*)\]\((?P<target>(?![a-z+]+:|#|/)[^)\s]+)\)")


def home(root: Path) -> str | None:
    """The web address of the repository at `root`, without a slash at the end, or None if nothing tells it."""
    server, repository = os.environ.get("GITHUB_SERVER_URL"), os.environ.get("GITHUB_REPOSITORY")
    workspace = os.environ.get("GITHUB_WORKSPACE")
    if server and repository and workspace and Path(workspace).resolve() == root.resolve():
        return f"{server.rstrip('/')}/{repository}"
    if not (root / ".git").exists():  # an unpacked archive inside somebody else's checkout is not that checkout
        return None
    try:
        remote = subprocess.run(
            ["git", "-C", str(root), "remote", "get-url", "origin"], capture_output=True, text=True, check=True
        ).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return None
    return address(remote)


def address(remote: str) -> str | None:
    """A git remote as a web address, or None for one that is no public place (a folder, a bare host name)."""
    found = REMOTE.fullmatch(remote.removesuffix("/").removesuffix(".git"))
    return f"https://{found['host'] or found['scp']}/{found['path']}" if found else None


def urls(root: Path) -> dict[str, str]:
    """Label to URL, as `[project.urls]` has them; empty if the home is not known."""
    built = root / "PKG-INFO"
    if built.exists():
        lines = HeaderParser().parsestr(built.read_text(encoding="utf-8")).get_all("Project-URL") or []
        return dict(line.split(", ", 1) for line in lines)
    if (base := home(root)) is None:
        return {}
    return {
        "Homepage": base,
        "Documentation": f"{base}/tree/main/docs",
        "Changelog": f"{base}/blob/main/CHANGELOG.md",
        "Issues": f"{base}/issues",
        "Source": base,
    }


def description(root: Path) -> str:
    """README.md as others read it, who have no checkout; of an unpacked sdist, what its metadata say."""
    built = root / "PKG-INFO"
    if built.exists():
        return str(HeaderParser().parsestr(built.read_text(encoding="utf-8")).get_payload())
    base = home(root)

    def absolute(link: re.Match[str]) -> str:
        if base is None:
            return "" if link["picture"] else link["text"]
        kind = "raw" if link["picture"] else "blob"
        return f"{link['picture']}[{link['text']}]({base}/{kind}/main/{link['target']})"

    return LINK.sub(absolute, (root / "README.md").read_text(encoding="utf-8"))


class ProjectUrls(MetadataHookInterface):
    """Hatchling's hook: fills the dynamic fields `urls` and `readme`."""

    def update(self, metadata: dict[str, Any]) -> None:
        if found := urls(Path(self.root)):
            metadata["urls"] = found
        metadata["readme"] = {"content-type": "text/markdown", "text": description(Path(self.root))}
