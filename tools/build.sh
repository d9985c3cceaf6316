#!/usr/bin/env bash
# Installs what is missing and builds: tools/build.sh [PRESET [TARGET]], by default all of `release`; the target `program` leaves
# the tests out. The program is build/PRESET/etendue.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
tools/setup.sh
cmake --preset "$preset" >/dev/null
cmake --build --preset "$preset" ${2:+--target "$2"}
