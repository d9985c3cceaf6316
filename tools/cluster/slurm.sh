#!/usr/bin/env bash
# One render as a Slurm array job, whose tasks render passes of it, and a job that merges them when all have ended.
#
#   tools/cluster/slurm.sh SCENE.gltf OUT.exr PASSES TASKS [options of etendue render…] [-- options of sbatch…]
#
# SCENE, OUT.exr and etendue (ETENDUE names it; default: on the PATH) are on a file system that all nodes share. Parts go to
# OUT.exr.parts/. A task that is requeued goes on from its last checkpoint. Where a task failed, the merge job ends with 2 and
# says which passes are missing: the same command again renders only these.
set -euo pipefail
etendue=${ETENDUE:-etendue}

render_part() { # PASSES TASKS PARTS SCENE options…: the array task
    local passes=$1 tasks=$2 parts=$3 scene=$4 task=$SLURM_ARRAY_TASK_ID
    shift 4
    local range=$((passes * task / tasks)):$((passes * (task + 1) / tasks)) part=$parts/$task.etd
    if [ -e "$part" ]; then set -- "$@" --resume "$part"; fi
    exec "$etendue" render "$scene" --passes "$range" --checkpoint "$part" "$@"
}

merge_parts() { # PASSES PARTS OUT
    exec "$etendue" merge "$2"/*.etd --passes "$1" -o "$3" --checkpoint "$2.etd"
}

submit() { # SCENE OUT PASSES TASKS options… -- options of sbatch…
    if [ $# -lt 4 ]; then
        sed -n '4p' "$0" >&2
        exit 2
    fi
    local scene=$1 out=$2 passes=$3 tasks=$4 parts=$2.parts
    shift 4
    local render=() sbatch=()
    while [ $# -gt 0 ] && [ "$1" != -- ]; do render+=("$1") && shift; done
    if [ $# -gt 0 ]; then shift; fi
    sbatch=("$@")
    # What auto would choose is chosen once, for all tasks.
    if [[ " ${render[*]} " != *" --algorithm "* ]]; then
        local chosen
        chosen=$("$etendue" inspect "$scene" --json | python3 -c 'import json, sys; print(*json.load(sys.stdin)["arguments"])')
        read -ra chosen <<<"$chosen"
        render+=("${chosen[@]}")
    fi
    mkdir -p "$parts"
    local self job
    self=$(realpath "$0")
    job=$(sbatch --parsable --job-name=etendue --array="0-$((tasks - 1))" --requeue --export=ALL --output="$parts/%a.log" \
        "${sbatch[@]}" "$self" --part "$passes" "$tasks" "$parts" "$scene" "${render[@]}")
    sbatch --parsable --job-name=etendue-merge --dependency="afterany:${job%%;*}" --export=ALL --output="$parts/merge.log" \
        "${sbatch[@]}" "$self" --merge "$passes" "$parts" "$out"
}

case ${1:-} in
--part) shift && render_part "$@" ;;
--merge) shift && merge_parts "$@" ;;
*) submit "$@" ;;
esac
