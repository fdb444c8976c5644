#!/usr/bin/env bash
# Print the Python for the virtual environment: the distribution's own where it is 3.11 or newer and has venv, else the first
# on the path. As root in CI a missing venv is installed, elsewhere the command is printed.
set -u
OWN=${OWN_PYTHON:-/usr/bin/python3}
new_enough() { "$1" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; }
has_venv() { "$1" -c 'import venv, ensurepip' 2>/dev/null; }
usable() { new_enough "$1" && has_venv "$1"; }

usable "$OWN" && { echo "$OWN"; exit 0; }
if new_enough "$OWN" && [ "$(id -u)" = 0 ] && [ "${CI:-}" = true ] && command -v apt-get >/dev/null; then
  echo "installing python3-venv" >&2
  { apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends python3-venv; } >/dev/null 2>&1
  usable "$OWN" && { echo "$OWN"; exit 0; }
fi
other=$(command -v python3) && usable "$other" && { echo "$other"; exit 0; }
if new_enough "$OWN" || { [ -n "$other" ] && new_enough "$other"; }; then
  echo "Python's venv is missing. Debian/Ubuntu: apt-get install python3-venv" >&2
else
  echo "dancetutor needs Python 3.11 or newer; set PYTHON=python3.X" >&2
fi
exit 1
