#!/usr/bin/env bash
# Rewrite the four lock files from pyproject.toml (needs uv); run it after changing a dependency. What they hold already stays
# at its version. All have the extra `all`: the demo and the tests use it.
set -euo pipefail
cd "$(dirname "$0")/.."
flags=(--universal --generate-hashes --python-version 3.11 --no-header --no-annotate --quiet)
"${UV:-uv}" pip compile "${flags[@]}" --extra all pyproject.toml -o requirements.lock
"${UV:-uv}" pip compile "${flags[@]}" --extra all --extra dev -c requirements.lock pyproject.toml -o requirements-dev.lock
"${UV:-uv}" pip compile "${flags[@]}" --extra character -c requirements.lock pyproject.toml -o requirements-character.lock
"${UV:-uv}" pip compile "${flags[@]}" --group site -o requirements-site.lock
