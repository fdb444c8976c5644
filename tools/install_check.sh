#!/usr/bin/env bash
# Install the wheel as a user would, with pipx and with uvx, into an empty home whose path has a space and umlauts, make it
# read-only and take the first steps. Needs a package registry; nothing is written outside a temporary folder.
set -euo pipefail
cd "$(dirname "$0")/.."
root=$(pwd)
folder=$(mktemp -d)
trap 'chmod -R u+w "$folder"; rm -rf "$folder"' EXIT
python=${PYTHON:-python3}
home="$folder/Jürgen Müller's Zuhause"
songs="$home/Lieder & Töne"
mkdir -p "$songs"
cp -r charts/two_left_feet "$songs/"

"$python" -m venv "$folder/tools"
"$folder/tools/bin/pip" install --quiet hatchling pipx uv
(cd "$root" && "$folder/tools/bin/hatchling" build -t wheel -d "$folder/dist")
wheel=$(ls "$folder"/dist/*.whl)

unset PYTHONPATH VIRTUAL_ENV XDG_CACHE_HOME XDG_CONFIG_HOME XDG_DATA_HOME
export HOME="$home"
"$folder/tools/bin/pipx" install "$wheel[all]"
command="$home/.local/bin/dancetutor"
site=$("$home/.local/share/pipx/venvs/dancetutor/bin/python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')
chmod -R a-w "$site"

cd "$songs"
"$command"
"$command" analyze two_left_feet --exit-zero | tail -1
LC_ALL=C PYTHONUTF8=0 PYTHONIOENCODING=ascii "$command" analyze two_left_feet --exit-zero | tail -1
"$command" annotate two_left_feet --diff | tail -1
"$command" animate two_left_feet/two_left_feet.ssc --index 0 --section 0:5 -o tänzerin.glb
"$command" page two_left_feet/two_left_feet.ssc --index 0 -o "übung 1.html"
"$command" render two_left_feet/two_left_feet.ssc --index 0 --section 8:9 --size 320x180 --quality draft -o "film ä.mp4"
"$folder/tools/bin/uvx" --from "$wheel" dancetutor --version
"$folder/tools/bin/uvx" --from "$wheel" dancetutor analyze two_left_feet --exit-zero | tail -1
echo "installed and used by pipx and uvx"
