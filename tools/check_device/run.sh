#!/usr/bin/env bash
# Checks this machine's Vulkan device with what tools/check_device.sh has packed around this script; needs bash 5, coreutils and
# gzip. Takes 8 minutes at most. Exit status 0 only where everything passed.
#
#   ./run.sh [--device NAME|INDEX] [--out FOLDER]     default: the first device that is no CPU; result
#
# FOLDER/result.json says what came of it: the device, tests, images, seconds to the first pass, rates by schedule, failures.
# The output of every step and the images lie beside it.
set -uo pipefail
export LC_ALL=C
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
device=${ETENDUE_DEVICE:-} out=$here/result
while [ $# -gt 0 ]; do
    case $1 in
        --device) device=${2:?"--device wants a name or an index"}; shift 2 ;;
        --out) out=${2:?"--out wants a folder"}; shift 2 ;;
        *) echo "usage: run.sh [--device NAME|INDEX] [--out FOLDER]" >&2; exit 2 ;;
    esac
done
total=470 # seconds; the rest of the 8 minutes is for what does not end at once when it is told to
mkdir -p "$out" && out=$(cd "$out" && pwd) || exit 2
rm -rf "$out"/{logs,images,caches,layers,result.json}
mkdir -p "$out"/{logs,images,caches/all,layers}
failures=() tests=() images=() starts=() rates=()
index=() names=() kinds=() drivers=() lacks=() chosen=0

# Every cache in a folder, those of the drivers by Mesa and by NVIDIA, too.
caches_in() {
    mkdir -p "$1/home"
    export HOME=$1/home XDG_CACHE_HOME=$1/xdg MESA_SHADER_CACHE_DIR=$1/mesa __GL_SHADER_DISK_CACHE_PATH=$1
}
text() { # as JSON
    local t=${1//[^ -~]/?}
    t=${t//\\/\\\\}
    printf '"%s"' "${t//\"/\\\"}"
}
join() { local IFS=,; printf '%s' "$*"; }
fail() { # NAME VERDICT LAST_LINE
    failures+=("{\"step\":$(text "$1"),\"verdict\":\"$2\",\"last_line\":$(text "$3")}")
}

# perform NAME SECONDS COMMAND…: runs it, with the output and what became of it in files of that name.
perform() {
    local log=$out/logs/${1//[ \/]/_} limit=$2 left=$((total - SECONDS)) start=${EPOCHREALTIME/./}
    shift 2
    [ $left -ge 3 ] || return
    [ "$limit" -lt $left ] || limit=$left
    timeout -k 5 "$limit" "$@" >"$log.txt" 2>&1 </dev/null &
    wait $!
    echo $? $(((${EPOCHREALTIME/./} - start) / 1000)) "$limit" >"$log.ended"
}
# judge NAME: leaves verdict, seconds, output and its last line, of a test that of its first error.
judge() {
    local log=$out/logs/${1//[ \/]/_} code taken limit line
    verdict="not run" seconds=null output="" last="the time for all steps was over"
    if [ -e "$log.ended" ]; then
        read -r code taken limit <"$log.ended"
        rm "$log.ended"
        printf -v seconds '%d.%03d' $((taken / 1000)) $((taken % 1000))
        output=$(<"$log.txt") last=""
        while read -r line; do [[ -z $line || $last = *" ERROR: "* ]] || last=$line; done <<<"$output"
        case $code in
            0) verdict=passed ;;
            124) verdict="timed out" ;;
            137) if [ "${seconds%.*}" -ge "$limit" ]; then verdict="timed out"; else verdict=killed; fi ;;
            *) verdict=failed ;;
        esac
    fi
    [ "$verdict" = passed ] || fail "$1" "$verdict" "$last"
    printf '%-44s %-9s %s s\n' "$1" "$verdict" "$seconds"
}
step() { # NAME SECONDS COMMAND…
    perform "$@"
    judge "$1"
}
found() { # REGEX: what its group matches in the output, else null
    if [[ $output =~ $1 ]]; then printf '%s' "${BASH_REMATCH[1]}"; else printf null; fi
}
line_end=$'\n'
statistic() { # FILE KEY: a number at the top of what --stats wrote, else null
    local output=""
    [ ! -e "$1" ] || output=$(<"$1")
    found "$line_end  \"$2\": (-?[0-9][-+.0-9e]*)"
}

write_result() {
    printf '{"version":%s,\n"device":%s,\n"kind":%s,\n"driver":%s,\n"passed":%s,\n"seconds":%d,\n' "$(text "$version")" \
        "$(text "${names[chosen]:-}")" "$(text "${kinds[chosen]:-}")" "$(text "${drivers[chosen]:-}")" \
        "$([ ${#failures[@]} -gt 0 ] && echo false || echo true)" $SECONDS
    printf '"first_passes":[%s],\n"images":[%s],\n"rates":[%s],\n"tests":[%s],\n"failures":[%s]}\n' "$(join "${starts[@]}")" \
        "$(join "${images[@]}")" "$(join "${rates[@]}")" "$(join "${tests[@]}")" "$(join "${failures[@]}")"
} >"$out/result.json"
stop_jobs() { kill $(jobs -p) 2>/dev/null; }
trap 'stop_jobs; fail run interrupted ""; write_result; exit 1' INT TERM
trap '' PIPE HUP # goes on where nobody watches any more

# The libraries that drivers may need, too, only where the machine has none that will do.
export LD_LIBRARY_PATH=$here/lib
etendue=$here/bin/etendue
caches_in "$out/caches/all"
version=$("$etendue" --version 2>/dev/null) || {
    LD_LIBRARY_PATH=$here/lib:$here/lib/common
    version=$("$etendue" --version 2>&1)
}

# The list has two lines or more a device: number and name; kind, driver and limits; what it lacks.
step devices 60 "$etendue" devices
chosen=
while IFS= read -r line; do
    n=$((${#index[@]} - 1))
    if [[ $line =~ ^([0-9]+)\ (.*)$ ]]; then
        index+=("${BASH_REMATCH[1]}") names+=("${BASH_REMATCH[2]% (default)}") kinds+=("") drivers+=("") lacks+=("")
    elif [[ $n -ge 0 && $line = "    not usable"* ]]; then
        lacks[n]=$line
    elif [[ $n -ge 0 && $line =~ ^\ {4}([^,]+),\ (.*),\ Vulkan\ [0-9] ]]; then
        kinds[n]=${BASH_REMATCH[1]} drivers[n]=${BASH_REMATCH[2]}
    fi
done <<<"$output"
for n in "${!index[@]}"; do
    [ -z "$chosen" ] || break
    if [ -n "$device" ]; then
        [[ $device != "${index[n]}" && ${names[n]} != *"$device"* ]] || chosen=$n
    elif [[ ${kinds[n]} != CPU && -z ${lacks[n]} ]]; then
        chosen=$n
    fi
done
if [ -z "$chosen" ] && [ "$verdict" = passed ]; then
    fail "choice of a device" failed "there is no ${device:-"usable device but CPUs; --device takes one of them"}"
    chosen=0 # the rest may still tell something
fi
: "${chosen:=0}"
device=${index[chosen]:-0}
export ETENDUE_DEVICE=$device # for the tests
echo "device $device: ${names[chosen]:-unknown}, ${drivers[chosen]:-unknown}"
render() { # STEP SECONDS SCENE OPTIONS…
    local name=$1 limit=$2 scene=$3
    shift 3
    step "$name" "$limit" "$etendue" render "$scene" --device "$device" --quiet "$@"
}

# Seconds of a whole run to its first pass, all caches empty; then with what that run has left in them.
for scene in cornell_box example films; do
    caches_in "$out/caches/$scene"
    stats=$out/logs/$scene.first.json
    render "first pass, $scene" 60 "$here/scenes/$scene.gltf" --passes 1 --size 64x64 -o "$out/images/first.exr" --stats "$stats"
    start_verdict=$verdict start_seconds=$seconds
    render "first pass again, $scene" 30 "$here/scenes/$scene.gltf" --passes 1 --size 64x64 -o "$out/images/first.exr"
    starts+=("{\"scene\":\"$scene\",\"verdict\":\"$start_verdict\",\"seconds\":$start_seconds,\"warm_seconds\":$seconds,$(
        )\"driver_compile_seconds\":$(statistic "$stats" driver_compile_seconds)}")
done
caches_in "$out/caches/all"

# Images against those of lavapipe with the same random numbers, and against converged references.
hundredths() { printf -v "$1" '%.2f' "${2#-}" && printf -v "$1" '%d' $((10#${!1/./})); } # VARIABLE NUMBER: bash has no fractions
compare() { # NAME REFERENCE MAX_RELMSE MAX_BIAS: adds to `entry`, and lowers `whole` where one is too large
    local relmse bias off most
    step "image $image, $1" 30 "$etendue" compare "$out/images/$image.exr" "$2" --max-relmse "$3"
    [ "$verdict" = passed ] || whole=failed
    relmse=$(found 'relMSE +(-?[0-9][-+.0-9e]*)') bias=$(found 'bias +[+]?(-?[0-9][-+.0-9e]*) %')
    entry+=",\"$1\":{\"relmse\":$relmse,\"relmse_limit\":$3,\"bias_percent\":$bias,\"bias_limit_percent\":${4:-null}}"
    [ -n "${4:-}" ] && [ "$verdict" = passed ] || return
    hundredths off "${bias/null/100}" && hundredths most "$4"
    [ $off -le $most ] && return
    whole=failed
    fail "image $image, $1" failed "the mean is off by $bias %"
}
while read -r image size passes algorithm noise bias_limit limit; do
    scene=$here/scenes/$image.gltf
    [ -e "$scene" ] || scene=$here/reference/$image/scene.gltf
    render "image $image" 60 "$scene" --size "$size" --passes "$passes" --algorithm "$algorithm" -o "$out/images/$image.exr"
    whole=$verdict entry="\"image\":\"$image\",\"render_seconds\":$seconds"
    if [ "$verdict" = passed ]; then
        compare lavapipe "$here/expected/$image.exr" "$noise" "$bias_limit"
        [ "$limit" = - ] || compare reference "$here/reference/$image/reference.exr" "$limit"
    fi
    images+=("{$entry,\"verdict\":\"$whole\"}")
done <"$here/images.txt"

for run in "cornell_box backward" "materials backward" "glass_in_fog bidirectional"; do
    read -r scene algorithm <<<"$run"
    for schedule in fused wavefront by-class; do
        stats=$out/logs/$scene.$schedule.json
        render "rate $scene, $schedule" 45 "$here/scenes/$scene.gltf" --size 1280x720 --time 3 --algorithm "$algorithm" \
            --schedule "$schedule" --stats "$stats" -o "$out/images/rate.exr"
        passes=$(statistic "$stats" passes) taken=$(statistic "$stats" seconds) samples=null
        if [ "$passes" != null ] && [ "$taken" != null ]; then
            printf -v taken '%.6f' "$taken" # bash knows no fractions: in microseconds
            taken=$((10#${taken/./}))
            [ $taken -eq 0 ] || samples=$((passes * 1280 * 720 * 1000000 / taken))
        fi
        rates+=("{\"scene\":\"$scene\",\"algorithm\":\"$algorithm\",\"schedule\":\"$schedule\",\"verdict\":\"$verdict\",$(
            )\"rays_per_second\":$(statistic "$stats" rays_per_second),\"samples_per_second\":$samples,\"passes\":$passes}")
    done
done

# Files of tests, which read shaders and kernels from here. The validation layer is on, and what it says fails them, too.
layer=libVkLayer_khronos_validation.so
step "validation layer" 30 bash -c 'gzip -dc "$0" >"$1"' "$here/lib/$layer.gz" "$out/layers/$layer"
printf '{"file_format_version":"1.2.0","layer":{"name":"VK_LAYER_KHRONOS_validation","type":"GLOBAL","library_path":"./%s",%s}}\n' \
    $layer '"api_version":"1.3.239","implementation_version":"1","description":"","instance_extensions":[{"name":"VK_EXT_debug_utils","spec_version":"2"}]' \
    >"$out/layers/validation.json"
export VK_LAYER_PATH=$out/layers TMPDIR=$out/caches ETENDUE_SOURCE=$here
mapfile -t files <"$here/tests.txt"
at_once=$(nproc) # a test is for the most part the driver compiling one kernel after the other
[ "$at_once" -le 4 ] || at_once=4
running=0
for file in "${files[@]}"; do
    if [ $running -eq "$at_once" ]; then
        wait -n
    else
        running=$((running + 1))
    fi
    (
        trap 'stop_jobs; exit' TERM
        perform "test $file" 180 "$here/bin/test_${file%/*}" --source-file="*/${file}_test.cpp" --test-suite-exclude=long
    ) &
done
wait
for file in "${files[@]}"; do
    judge "test $file"
    passed=$(found 'test cases: +[0-9]+ . +([0-9]+) passed') failed=$(found 'passed . +([0-9]+) failed')
    messages=0
    while [[ $output = *"${line_end}validation: "* ]]; do
        messages=$((messages + 1)) output=${output#*"${line_end}validation: "}
    done
    if [ "$verdict" = passed ] && ! [ "${passed/null/0}" -gt 0 ]; then # of no cases all pass
        verdict=failed
        fail "test $file" failed "there are no such cases"
    fi
    tests+=("{\"file\":\"$file\",\"verdict\":\"$verdict\",\"seconds\":$seconds,\"cases_passed\":$passed,\"cases_failed\":$failed,$(
        )\"validation_messages\":$messages}")
done

# The caches of another run would be no cold start; the tests' are large.
rm -rf "$out"/{caches,layers} "$out"/images/{first,rate}.exr
write_result
if [ ${#failures[@]} -gt 0 ]; then
    echo "${#failures[@]} steps did not pass; $out/result.json names them" >&2
    exit 1
fi
echo "all passed in $SECONDS s; $out/result.json"
