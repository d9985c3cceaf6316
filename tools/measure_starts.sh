#!/usr/bin/env bash
# Seconds from an empty machine to the first pass: `render --passes 1 --size 64x64` with the program's cache and the driver's in
# empty folders, and the three largest kernels of each scene in kB of SPIR-V.
#
#   tools/measure_starts.sh [SCENE…]     default: every example
#   ALGORITHM=bidirectional tools/measure_starts.sh …     default: auto
set -euo pipefail
program=$(cd "$(dirname "$0")/.." && pwd)/build/release/etendue
scenes=("$@")
[ ${#scenes[@]} -gt 0 ] || scenes=("$(dirname "$0")"/../scenes/*.gltf)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
grep -m 1 "model name" /proc/cpuinfo | sed 's/.*: /processor: /'
printf '%-28s %8s   %s\n' scene seconds "largest kernels, kB"
for scene in "${scenes[@]}"; do
    rm -rf "$folder"/*
    mkdir "$folder/home"
    start=$(date +%s.%N)
    env HOME="$folder/home" XDG_CACHE_HOME="$folder/own" MESA_SHADER_CACHE_DIR="$folder/driver" "$program" render "$scene" \
        --algorithm "${ALGORITHM:-auto}" --passes 1 --size 64x64 --quiet -o "$folder/image.exr"
    seconds=$(awk "BEGIN { print $(date +%s.%N) - $start }")
    kernels=$(find "$folder/own" -name '*.spv' -printf '%s %f\n' | sort -rn | head -n 3 |
        awk '{sub(/-[0-9a-f]*\.spv/, "", $2); printf "%s %.0f  ", $2, $1 / 1024}')
    printf '%-28s %8.1f   %s\n' "$(basename "$scene")" "$seconds" "$kernels"
done
