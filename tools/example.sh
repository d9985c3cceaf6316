#!/usr/bin/env bash
# Sets up, builds, and renders an example to out/example.exr.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/build.sh release program
mkdir -p out
build/release/etendue render scenes/example.gltf --size 640x400 --time 10 -o out/example.exr
echo "out/example.exr"
