#!/usr/bin/env bash
# What becomes of the scenes that others make: runs `inspect` and one pass of every .gltf and .glb below a folder, under the
# address and undefined-behaviour sanitizers, and lists exit codes, warnings, samples that are not finite and the seconds of each.
# Fails where a scene crashes, hangs, takes more than 20 s, or makes a sanitizer speak. A scene that is refused in one line
# is none of these.
#
#   tools/corpus.sh FOLDER                builds the preset `sanitize`, which takes a while at first
#   ETENDUE_PROGRAM=… tools/corpus.sh …   takes that program instead
#   LIMIT=60 tools/corpus.sh …            other seconds
set -euo pipefail
[ $# = 1 ] && [ -d "$1" ] || { echo "usage: tools/corpus.sh FOLDER" >&2; exit 2; }
corpus=$(realpath -- "$1")
limit=${LIMIT:-20}
program=${ETENDUE_PROGRAM:+$(realpath -- "$ETENDUE_PROGRAM")}
cd "$(dirname "$0")/.."
if [ -z "$program" ]; then
    tools/build.sh sanitize program
    program=build/sanitize/etendue
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
# What drivers and loaders keep until the end is no leak of ours.
export ASAN_OPTIONS=detect_leaks=0:exitcode=99 UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1:exitcode=99

code=0 seconds=0
attempt() { # NAME WORDS… -> code, seconds
    local name=$1 start
    start=$(date +%s.%N)
    shift
    code=0
    timeout -k 5 "$limit" "$program" "$@" >"$folder/$name.out" 2>"$folder/$name.err" || code=$?
    seconds=$(awk "BEGIN { printf \"%.1f\", $(date +%s.%N) - $start }")
}

failed=0 count=0
printf '%-56s %7s %7s %8s %10s %15s\n' scene inspect render warnings non-finite seconds
while IFS= read -r -d '' scene; do
    count=$((count + 1))
    rm -f "$folder"/*
    attempt inspect inspect "$scene" --algorithm backward  # what the file asks for, without the kernels of a pilot
    inspected=$code inspecting=$seconds
    attempt render render "$scene" --passes 1 --size 64x64 -o "$folder/image.exr" --stats "$folder/stats.json"
    warnings=$(grep -c '^warning: ' "$folder/inspect.err" || true)
    black=$(sed -n 's/.*"non_finite_samples": \([0-9]*\).*/\1/p' "$folder/stats.json" 2>/dev/null || true)
    verdict=
    for result in "$inspected" "$code"; do
        case $result in
            0 | 2) ;;
            124 | 137) verdict="  more than $limit s" ;;
            *) verdict="  CRASH" ;;
        esac
    done
    [ "$inspected" = "$code" ] || [ -n "$verdict" ] || verdict="  inspect and render differ"
    [ -z "$verdict" ] || failed=$((failed + 1))
    printf '%-56s %7s %7s %8s %10s %7s %7s%s\n' "${scene#"$corpus"/}" "$inspected" "$code" "$warnings" "${black:--}" "$inspecting" \
        "$seconds" "$verdict"
    [ "$code" = 0 ] || tail -n 1 "$folder/render.err" | cut -c 1-300 | sed 's/^/    /'
    grep -h -m 1 -E 'runtime error|ERROR: AddressSanitizer' "$folder"/*.err | sed 's/^/    /' || true
done < <(find "$corpus" -type f \( -iname '*.gltf' -o -iname '*.glb' \) -print0 | sort -z)
echo "$count scenes, $failed of them failed"
[ "$failed" = 0 ]
