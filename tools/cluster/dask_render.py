#!/usr/bin/env python3
"""One render or measurement by the workers of a Dask cluster: tasks are runs of etendue on ranges of passes, done again where a worker dies.

    tools/cluster/dask_render.py SCENE.gltf -o OUT.exr --error 0.02 --cluster ssh:anna,bert -- --size 1920x1080

Wants `dask.distributed`, and `dask-jobqueue` for slurm; schedulers in Kubernetes and elsewhere are named by their address. Scene and
program are on a file system that all workers share; parts come back as results of the tasks. See tools/cluster/README.md.
"""
import argparse, json, os, subprocess, sys, tempfile
from dask.distributed import Client, LocalCluster, SSHCluster, as_completed

COMMANDS = ["render", "measure"]


def make_cluster(kind, workers):
    if kind == "local":
        return LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None)
    if kind.startswith("ssh:"):  # the first host also schedules
        hosts = kind[4:].split(",")
        return SSHCluster([hosts[0]] + hosts, worker_options={"nthreads": 1})
    if kind == "slurm":
        from dask_jobqueue import SLURMCluster
        cluster = SLURMCluster(cores=os.cpu_count(), processes=1, memory="8GB")  # or as its configuration file says
        cluster.scale(jobs=workers)
        return cluster
    return kind  # an address


def run_range(program, command, scene, options, first, end, threads):
    """On a worker: passes first to end - 1; the bytes of their part."""
    environment = dict(os.environ, LP_NUM_THREADS=str(threads)) if threads else None
    with tempfile.TemporaryDirectory() as folder:
        part = os.path.join(folder, "part.etd")
        words = [program, command, scene, "--passes", f"{first}:{end}", "--checkpoint", part, "--quiet", *options]
        run = subprocess.run(words, env=environment, capture_output=True, text=True)
        if run.returncode: raise RuntimeError(run.stderr.strip())
        return open(part, "rb").read()


def main():
    words = sys.argv[1:]
    split = words.index("--") if "--" in words else len(words)
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0], epilog="Behind --: options of the command.")
    parser.add_argument("scene")
    parser.add_argument("-o", "--output", required=True, help="image; of measure, a folder")
    parser.add_argument("--command", choices=COMMANDS, default="render")
    parser.add_argument("--passes", type=int, help="stop after so many")
    parser.add_argument("--error", type=float, help="stop when the error is below this with 95 %% confidence")
    parser.add_argument("--cluster", default="local", help="local, ssh:HOST,…, slurm, or tcp://SCHEDULER:8786")
    parser.add_argument("--workers", type=int, default=os.cpu_count())
    parser.add_argument("--chunk", type=int, default=16, help="passes of a task; of measure, whole sixteens")
    parser.add_argument("--program", default="etendue")
    a, options = parser.parse_args(words[:split]), words[split + 1:]
    if (a.passes is None) == (a.error is None): parser.error("one of --passes and --error is wanted")
    if a.command == "render" and "--algorithm" not in options:  # what auto would choose is chosen once, for all workers
        chosen = subprocess.run([a.program, "inspect", a.scene, "--json"], check=True, capture_output=True, text=True)
        options += json.loads(chosen.stdout)["arguments"]
    scene, threads = os.path.abspath(a.scene), max(1, os.cpu_count() // a.workers) if a.cluster == "local" else None
    client = Client(make_cluster(a.cluster, a.workers))
    folder = tempfile.mkdtemp(dir=os.path.dirname(os.path.abspath(a.output)), prefix=".parts-")
    whole, stats = a.output + ".etd", os.path.join(folder, "stats.json")
    tasks, parts, submitted, done, looked, error = as_completed(), [], 0, 0, 0, None

    def submit():
        nonlocal submitted
        end = submitted + a.chunk if a.passes is None else min(a.passes, submitted + a.chunk)
        if submitted < end:
            task = client.submit(run_range, a.program, a.command, scene, options, submitted, end, threads, retries=3, pure=False)
            task.passes, submitted = end - submitted, end
            tasks.add(task)

    def merge(*more):
        words = [a.program, "merge", *parts, "--checkpoint", whole, "-o", a.output, "--stats", stats, "--quiet", *more]
        subprocess.run(words, check=True)
        for part in set(parts) - {whole}:
            os.remove(part)
        parts[:] = [whole]
        return json.load(open(stats))

    for _ in range(2 * max(1, len(client.scheduler_info()["workers"]), a.workers)):
        submit()
    for task in tasks:
        parts.append(os.path.join(folder, f"{task.key}.etd"))
        open(parts[-1], "wb").write(task.result())  # fails where all retries did
        done += task.passes
        if done >= looked + looked // 8 + 1:  # as render --error looks: not so often that one look in many is lucky
            looked, error = done, merge("--partial")["relative_error_bound"]
        goal_met = a.error is not None and error is not None and error <= a.error
        share = done / a.passes if a.passes else min(1, (a.error / error) ** 2 if error else 0)
        print(f"\r[{'#' * int(40 * share):40}] {done} passes, error below {error or float('inf'):.4g} ", end="", file=sys.stderr)
        if not goal_met:
            submit()
    result = merge()  # all that was submitted: fails where a pass is missing
    os.remove(stats), os.rmdir(folder), client.close()
    print(f"\n{a.output}: {result['pass_count']} passes, error {result['estimated_relative_error']:.4g}", file=sys.stderr)


if __name__ == "__main__":
    main()
