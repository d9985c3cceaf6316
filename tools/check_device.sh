#!/usr/bin/env bash
# Packs a check of another machine's GPU into a folder: the program, tests, scenes and images to compare with, for any x86-64
# Linux of glibc 2.35 or later that has a Vulkan loader and a driver. There, FOLDER/run.sh runs all and writes result.json
# (tools/check_device/run.sh says how).
#
#   tools/check_device.sh [--run] [FOLDER]     default: build/check_device; --run: runs it here at once, too
#   BUILD=DIR tools/check_device.sh …          another build than build/release
#   ETENDUE_SHARED=DIR …                       with the reference images there (default: ../shared)
#   ETENDUE_DEVICE=NAME|INDEX … --run          on that device
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
build=${BUILD:-$root/build/release}
shared=${ETENDUE_SHARED:-$root/../shared}
run=
if [ "${1:-}" = --run ]; then run=1; shift; fi
if [ $# -gt 1 ] || [[ "${1:-}" = -* ]]; then sed -n '2,9s/^# \{0,1\}//p' "$0" >&2; exit 2; fi
folder=${1:-$root/build/check_device}
most_megabytes=60

# Only what was packed before is replaced: the folder might be someone's home.
if [ -d "$folder" ] && [ ! -e "$folder/images.txt" ] && [ -n "$(ls -A "$folder")" ]; then
    echo "$folder is not empty, and nothing that was packed" >&2
    exit 2
fi
rm -rf "$folder"
mkdir -p "$folder"/{bin,lib/common,scenes,reference,expected,tests/kernels,tests/host}
folder=$(cd "$folder" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

for program in etendue tests/test_kernels tests/test_contracts; do
    strip -o "$folder/bin/$(basename "$program")" "$build/$program"
done
cp "$root/tools/check_device/run.sh" "$folder"

# Libraries that a driver may need as well lie apart: of these a driver has to find the machine's own, which may be newer, and
# ours are for machines that have none. The C library and the loader of Vulkan belong to the machine.
ldd "$folder"/bin/* | awk '$3 ~ /^\// { print $3 }' | sort -u | while read -r library; do
    case $(basename "$library") in
        libc.so* | libm.so* | libpthread.so* | libdl.so* | librt.so* | libvulkan.so*) ;;
        libstdc++.so* | libgcc_s.so* | libz.so*) cp -L "$library" "$folder/lib/common" ;;
        *) cp -L "$library" "$folder/lib" ;;
    esac
done
# The tests want the validation layer, whose 22 MB shrink to 5.
layer=libVkLayer_khronos_validation.so
gzip -9c "$(ldconfig -p | awk -v name=$layer '$1 == name { print $NF; exit }')" >"$folder/lib/$layer.gz"

# What the tests read of the checkout, and their list, the longest first: they run side by side.
cp -r "$root/shaders" "$folder"
cp "$root"/tests/kernels/*.comp "$folder/tests/kernels"
cp -r "$root"/tests/host/{photometry,rays} "$folder/tests/host"
long=(contracts/surface contracts/external_light)
printf '%s\n' "${long[@]}" >"$folder/tests.txt"
for file in "$root"/tests/{kernels,contracts}/*_test.cpp; do
    name=${file#"$root/tests/"} name=${name%_test.cpp}
    [[ " ${long[*]} " = *" $name "* ]] || echo "$name" >>"$folder/tests.txt"
done

cp "$root"/scenes/*.gltf "$root"/scenes/cloud.nrrd "$folder/scenes"
references=(cornell_rgb cornell_spectral furnace media_iso veach_mis)
for name in "${references[@]}"; do
    if [ -d "$shared/reference/$name" ]; then
        mkdir "$folder/reference/$name"
        cp "$shared/reference/$name"/{scene.gltf,reference.exr} "$folder/reference/$name"
        chmod -R u+w "$folder/reference/$name"
    else
        echo "left out: there is no $shared/reference/$name"
    fi
done
rm -f "$folder/reference/cornell_spectral/reference.exr" # of another unit of radiance: only the image made here is compared

# Images to compare with, made here on lavapipe. The device takes the same random numbers, so that most of its paths are the same:
# it may be as far off as another seed is, its mean by 0.2 % and twice the noise. What it may be off a converged reference is
# half as much again as the image made here.
images=( # name, size, passes, algorithm
    "cornell_rgb 256x256 32 backward"      "cornell_spectral 256x256 32 backward" "furnace 128x128 64 backward"
    "media_iso 128x128 64 backward"        "veach_mis 128x128 64 backward"        "cornell_box 128x128 64 bidirectional"
    "materials 128x128 32 backward"        "films 128x128 32 backward"            "grin 128x128 32 backward"
    "cloud 128x128 32 backward"            "many_lights 128x128 32 backward"      "lamps 128x128 64 forward"
    "caustic_box 128x128 64 bidirectional" "glass_in_fog 96x96 64 bidirectional"
)
program() { LD_LIBRARY_PATH=$folder/lib:$folder/lib/common "$folder/bin/etendue" "$@"; }
relmse() { program compare "$1" "$2" | awk '$1 == "relMSE" { print $2 }'; }
for image in "${images[@]}"; do
    read -r name size passes algorithm <<<"$image"
    scene=$folder/scenes/$name.gltf
    [ -e "$scene" ] || scene=$folder/reference/$name/scene.gltf
    [ -e "$scene" ] || continue
    for seed in 0 1; do
        program render "$scene" --size "$size" --passes "$passes" --algorithm "$algorithm" --seed $seed --quiet \
            --device llvmpipe -o "$scratch/$seed.exr"
    done
    noise=$(relmse "$scratch/1.exr" "$scratch/0.exr") limit=-
    if [ -e "$folder/reference/$name/reference.exr" ]; then
        limit=$(awk "BEGIN { print 1.5 * $(relmse "$scratch/0.exr" "$folder/reference/$name/reference.exr") }")
    fi
    bias=$(awk "BEGIN { printf \"%.2f\", 0.2 + 200 * sqrt($noise / ${size/x/ / }) }")
    mv "$scratch/0.exr" "$folder/expected/$name.exr"
    echo "$name $size $passes $algorithm $noise $bias $limit" >>"$folder/images.txt"
done

megabytes=$(du -sm --apparent-size "$folder" | cut -f 1)
echo "$folder: $megabytes MB"
if [ "$megabytes" -ge $most_megabytes ]; then
    echo "that is more than $most_megabytes MB" >&2
    exit 1
fi
[ -z "$run" ] || exec "$folder/run.sh"
