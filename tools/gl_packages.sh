#!/usr/bin/env bash
# Before the tests: OpenGL for the `gl` renderer. As root in CI it is installed, elsewhere the command is printed.
set -u
have() { python3 -c "import ctypes; ctypes.CDLL('libEGL.so.1'); ctypes.CDLL('libGL.so.1')" 2>/dev/null; }
have && exit 0
if [ "$(id -u)" = 0 ] && [ "${CI:-}" = true ] && command -v apt-get >/dev/null; then
  echo "installing libegl1 libgl1 for the tests of --renderer gl"
  { apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends libegl1 libgl1; } >/dev/null 2>&1
  have && exit 0
  echo "installing libegl1 libgl1 failed; the tests of --renderer gl will be skipped"
  exit 0
fi
echo "No OpenGL found: the tests of --renderer gl will be skipped. Debian/Ubuntu: apt-get install libegl1 libgl1"
