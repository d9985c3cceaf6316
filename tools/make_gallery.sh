#!/usr/bin/env bash
# Renders the pictures of the README's gallery, and writes the table of them: seconds of rendering, and the relative error that the
# program itself estimates. Takes about fourteen minutes on two cores.
#
#   tools/make_gallery.sh            pictures to scenes/gallery, the table into README.md, between its two marks
#   tools/make_gallery.sh FOLDER     all of it to another folder, the table as FOLDER/README.md
#
# It takes build/release/etendue, or the program that ETENDUE_PROGRAM names. `bench` makes the PNGs: it draws the image that it is
# given as a reference so bright that the mean of its green is 0.25. Sizes are such that a PNG takes some 50 kB at most;
# noise hardly packs. Scenes of which nothing shall be seen are left out.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
gallery=scenes/gallery
folder=$(realpath -m -- "${1:-$root/$gallery}")
program=$(realpath -- "${ETENDUE_PROGRAM:-$root/build/release/etendue}")
cd "$root"
columns=4

# Scene, size, seconds, algorithm. `auto` stands where the scene tells without a pilot, which would take longer than these renders.
pictures=(
    "example      176x110  30 bidirectional"
    "glass_in_fog 144x144  30 bidirectional"
    "films        180x100  30 auto"
    "cloud        240x160  30 auto"
    "rainbow      162x108  30 forward"
    "iced_water   132x132 120 bidirectional"
    "prism        168x112  30 forward"
    "grin         216x144  30 auto"
    "cornell_box  168x126  30 auto"
    "pool         160x160  60 bidirectional"
    "caustic_box  132x132  30 bidirectional"
    "finishes     216x120  30 auto"
    "materials    184x115  30 auto"
    "lamps        184x104  30 auto"
    "many_lights  160x100  30 auto"
    "retarders    192x96   20 backward"
    "glass_table  168x112  30 backward"
    "calcite      180x120  40 backward"
    "fogbow       144x144  30 auto"
)

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$folder"

number() { sed -n "s/^  \"$2\": \"\?\([^\"]*[^\",]\)\"\?,\?\$/\1/p" "$scratch/$1.json"; } # SCENE KEY: of --stats

for picture in "${pictures[@]}"; do
    read -r scene size seconds algorithm <<<"$picture"
    "$program" render "scenes/$scene.gltf" --size "$size" --time "$seconds" --algorithm "$algorithm" --quiet \
        -o "$scratch/$scene.exr" --stats "$scratch/$scene.json"
    "$program" bench "scenes/$scene.gltf" --reference "$scratch/$scene.exr" --algorithms "$(number "$scene" algorithm)" \
        --time 0.01 --quiet -o "$scratch/$scene" >/dev/null
    mv "$scratch/$scene/$scene.reference.png" "$folder/$scene.png"
    echo "$scene: $(number "$scene" estimated_relative_error), $(stat -c %s "$folder/$scene.png") bytes" >&2
done

# The table, with pictures at PREFIX. Markdown wants a first row of its own: it is the first row of pictures.
table() {
    local start i image text scene
    for ((start = 0; start < ${#pictures[@]}; start += columns)); do
        image="|" text="|"
        for ((i = start; i < start + columns; ++i)); do
            read -r scene _ <<<"${pictures[i]:-}" || true
            image+=" ${scene:+![$scene]($1$scene.png)} |"
            text+=" ${scene:+$scene<br>$(number "$scene" seconds | xargs printf '%.0f') s, $(
                number "$scene" estimated_relative_error | awk '{printf $1 < 0.0995 ? "%.1f %%" : "%.0f %%", 100 * $1}')} |"
        done
        echo "$image"
        [ "$start" -gt 0 ] || printf '|%s\n' "$(printf -- '---|%.0s' $(seq "$columns"))"
        echo "$text"
    done
    read -r scene _ <<<"${pictures[0]}"
    echo
    echo "Seconds of rendering, start and compilation excluded, and relative error, the root of the relMSE, as the program estimates it."
    echo "On $(nproc) threads of $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1), $(number "$scene" device),"
    echo "$(number "$scene" driver); kernels may come from the caches, and other work may have shared the cores."
    echo "The mean of green is 0.25 in every picture; what is brighter than white is cut."
}

if [ "$folder" = "$root/$gallery" ]; then
    { echo && table "$gallery/" && echo; } >"$scratch/table.md"
    awk -v table="$scratch/table.md" '
        /^<!-- end of the gallery -->/ { inside = 0 }
        !inside { print }
        /^<!-- gallery: / { inside = 1; while ((getline line < table) > 0) print line }' README.md >"$scratch/README.md"
    cp "$scratch/README.md" README.md
else
    { echo "# Gallery" && echo && table ""; } >"$folder/README.md"
fi
