#!/usr/bin/env bash
# Installs every package that étendue needs on Debian 12. Safe to run again: it does nothing where all is there.
#
#   tools/setup.sh                 compiler, libraries, Mesa 25 from bookworm-backports
#   tools/setup.sh --drivers       also Mesa 22.3 and SwiftShader, unpacked (not installed) under build/drivers,
#                                  so that the tests can run on them beside the system's driver
set -euo pipefail
cd "$(dirname "$0")/.."

packages=(
    cmake ninja-build g++ pkg-config clang-format
    libvulkan-dev vulkan-validationlayers libvulkan1
    glslang-dev glslang-tools spirv-tools spirv-headers libglm-dev libtinygltf-dev libopenexr-dev libfmt-dev
    libcli11-dev nlohmann-json3-dev doctest-dev libstb-dev gnuplot-nox
    libmeshoptimizer-dev libdraco-dev libwebp-dev # packed meshes and textures of glTF
    libglfw3-dev libimgui-dev fonts-dejavu-core # the window
    xvfb libxtst-dev # tests of the window
    libopenvdb-dev libboost-dev # grids of media; OpenVDB's headers want Boost's
)
as_root() { if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi; }
apt_get() { as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0 "$@"; }
installed() { dpkg-query -W -f '${Status}' "$1" 2>/dev/null | grep -q 'ok installed'; }

missing=()
for package in "${packages[@]}"; do installed "$package" || missing+=("$package"); done
if [ ${#missing[@]} -gt 0 ]; then
    apt_get update
    apt_get install --no-install-recommends -y "${missing[@]}"
fi

# Mesa 25 comes from bookworm-backports, read from wherever this machine reads Debian.
mesa_version() { dpkg-query -W -f '${Version}' mesa-vulkan-drivers 2>/dev/null | grep -oE '^[0-9]+' || echo 0; }
if [ "$(mesa_version)" -lt 24 ]; then
    mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Codename: bookworm' 'Created-By: Packages' 2>/dev/null | head -n 1)
    if [ -n "$mirror" ] && [ ! -e /etc/apt/sources.list.d/etendue-backports.list ]; then
        echo "deb ${mirror%/} bookworm-backports main" | as_root tee /etc/apt/sources.list.d/etendue-backports.list >/dev/null
        apt_get update
    fi
    apt_get install --no-install-recommends -y -t bookworm-backports mesa-vulkan-drivers ||
        apt_get install --no-install-recommends -y mesa-vulkan-drivers
fi

# Other drivers, unpacked beside the installed one. A driver file written here names the unpacked library.
unpack_driver() { # NAME ICD_LIBRARY PACKAGE=VERSION…
    local name=$1 library=$2 folder
    shift 2
    folder=$PWD/build/drivers/$name
    [ -e "$folder/icd.json" ] && return
    mkdir -p "$folder/packages"
    (cd "$folder/packages" && apt-get -qq download "$@")
    for package in "$folder"/packages/*.deb; do dpkg -x "$package" "$folder"; done
    rm -r "$folder/packages"
    printf '{"file_format_version":"1.0.0","ICD":{"library_path":"%s","api_version":"1.3.0"}}\n' \
        "$(find "$folder" -name "$library" | head -n 1)" >"$folder/icd.json"
}
if [ "${1:-}" = --drivers ]; then
    unpack_driver mesa22 libvulkan_lvp.so mesa-vulkan-drivers/bookworm libllvm15
    unpack_driver swiftshader libvk_swiftshader.so chromium-common
fi
