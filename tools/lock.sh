#!/usr/bin/env bash
# Rewrite the three lock files from pyproject.toml (needs uv); run it after changing a dependency.
set -euo pipefail
cd "$(dirname "$0")/.."
flags=(--universal --generate-hashes --python-version 3.11 --no-header --no-annotate --quiet)
"${UV:-uv}" pip compile "${flags[@]}" pyproject.toml -o requirements.lock
"${UV:-uv}" pip compile "${flags[@]}" --extra dev -c requirements.lock pyproject.toml -o requirements-dev.lock
"${UV:-uv}" pip compile "${flags[@]}" --extra character -c requirements.lock pyproject.toml -o requirements-character.lock
