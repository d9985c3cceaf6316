#!/usr/bin/env bash
# Sets up, builds, and runs the tests.
#
#   tools/test.sh             the suite
#   tools/test.sh long        the longer statistical runs, too
#   tools/test.sh drivers     the device tests again on Mesa 22.3 and SwiftShader, unpacked beside the installed driver; of images the quickest
set -euo pipefail
cd "$(dirname "$0")/.."
tools/build.sh release
run_tests() { ctest --test-dir build/release --output-on-failure --parallel "$(nproc)" "$@"; }
case "${1:-}" in
    "") run_tests -LE long ;;
    long) run_tests ;;
    drivers)
        tools/setup.sh --drivers
        # Both render up to thirty times more slowly than the installed lavapipe: of the images the quickest.
        for driver in mesa22 swiftshader; do
            echo "== $driver"
            VK_DRIVER_FILES=$PWD/build/drivers/$driver/icd.json VK_ICD_FILENAMES=$PWD/build/drivers/$driver/icd.json \
                run_tests -L device -LE long -R '^(kernels|contracts)/|^renders/(transparency|lighting|furnace)$'
        done ;;
    *) echo "usage: tools/test.sh [long|drivers]" >&2; exit 2 ;;
esac
