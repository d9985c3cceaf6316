#!/usr/bin/env python3
"""Prints the time to error of étendue and of other path tracers on the same cores, in one run.

    tools/compare_peers.py [--threads 1] [--scenes DIR] [--repeats 3] [SCENE[=ERROR] …]

DIR/SCENE holds scene.gltf and reference.exr. ERROR is the relMSE to reach (0.01 where nothing is said). For every
renderer the tool finds the two powers of two, in samples a pixel, with ERROR between their errors, then renders
them in turn with the others, `--repeats` times with different seeds: a machine that slows down for a while slows
all of them down. Between the two (medians) a power law says how many samples reach ERROR, and the larger one says
how fast samples are: rendering alone, without start, scene and compilation. The reference's own noise (residual)
is subtracted.

The peers come into Python environments under build/peers: Mitsuba 3 (with LLVM 19, unpacked from Debian's package),
LuxCore, Cycles (Blender's module). One that is missing, or that cannot do a scene, is a line in the report and no
failure.
"""

import argparse
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PEERS = ROOT / "build" / "peers"
PACKAGES = {"mitsuba": ["mitsuba"], "luxcore": ["pyluxcore"], "cycles": ["bpy"]}
# relMSE to reach, and the noise that is left in the reference
SCENES = {"cornell_rgb": (0.01, 4.4e-4), "veach_mis": (0.01, 2.0e-4), "furnace": (0.001, 1.9e-5)}


def note(text):
    print(text, file=sys.stderr, flush=True)


# ---- The environment, in which this script runs itself again


def environment_for(name):
    """Blender's module pins an old numpy: an environment a peer keeps them apart."""
    return PEERS / name / "bin" / "python"


def installed(name):
    return (PEERS / name / "installed").exists()


def set_up(names):
    for name in names:
        python = environment_for(name)
        if installed(name):
            continue
        note(f"setting up {name} in {PEERS.relative_to(ROOT)}")
        PEERS.mkdir(parents=True, exist_ok=True)
        subprocess.run([sys.executable, "-m", "venv", PEERS / name], check=True)
        done = subprocess.run(
            [
                python,
                "-m",
                "pip",
                "install",
                "--quiet",
                "--disable-pip-version-check",
                *PACKAGES.get(name, []),
                "numpy",
                "OpenEXR",
            ],
            capture_output=True,
            text=True,
        )
        if done.returncode == 0:
            (PEERS / name / "installed").touch()  # the last thing: an interrupted set-up is done again
        else:
            note(f"{name}: cannot be installed: {(done.stderr.strip().splitlines() or ['?'])[-1]}")


def find_llvm():
    """LLVM 19 for Mitsuba; older ones abort on AVX-512."""

    def look():
        folders = [Path("/usr/lib"), PEERS / "llvm"]
        return next((p for f in folders if f.exists() for p in sorted(f.rglob("libLLVM.so.19*"))), None)

    if look() is None:
        folder = PEERS / "llvm"
        folder.mkdir(parents=True, exist_ok=True)
        subprocess.run(
            "apt-get -qq download libllvm19 && dpkg -x libllvm19_*.deb . && rm libllvm19_*.deb",
            shell=True,
            cwd=folder,
            capture_output=True,
        )
    return look()


# ---- Renderers: render(samples, seed) -> (image, seconds, samples done)


class Etendue:
    name = "étendue"

    def __init__(self, program, scene, width, height, cores, folder):
        self.command = [
            "taskset",
            "-c",
            cores,
            str(program),
            "render",
            str(scene),
            "--size",
            f"{width}x{height}",
            "--quiet",
        ]
        self.environment = os.environ | {"LP_NUM_THREADS": str(cores.count(",") + 1)}
        self.folder = folder
        self.render(1, 1)  # fills the caches of kernels
        stats = self.render(1, 1, stats_only=True)
        self.description = f"étendue {stats['version']}, {stats['driver']}, {stats['schedule']}"

    def render(self, samples, seed, stats_only=False):
        image, stats = self.folder / "etendue.exr", self.folder / "etendue.json"
        done = subprocess.run(
            [
                *self.command,
                "--passes",
                str(samples),
                "--seed",
                str(seed),
                "-o",
                str(image),
                "--stats",
                str(stats),
            ],
            env=self.environment,
            capture_output=True,
            text=True,
        )
        if done.returncode != 0:
            raise RuntimeError((done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1])
        values = json.loads(stats.read_text())
        return values if stats_only else (read_exr(image), values["seconds"], values["passes"])

    def close(self):
        pass


class Peer:
    def __init__(self, name, scene, width, height, cores, folder, environment):
        self.name, self.file = name, folder / f"{name}.npy"
        if not installed(name):
            raise RuntimeError("could not be installed")
        worker = ROOT / "tools" / "peers" / f"{name}_worker.py"
        self.process = subprocess.Popen(
            [
                "taskset",
                "-c",
                cores,
                str(environment_for(name)),
                str(worker),
                str(scene),
                str(width),
                str(height),
                str(cores.count(",") + 1),
            ],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            env=os.environ | environment,
        )
        self.description = self._reply()["ready"]
        self.is_warm = False

    def _reply(self):
        line = self.process.stdout.readline()
        if not line:
            raise RuntimeError(f"ended with code {self.process.wait()}")
        reply = json.loads(line)
        if "error" in reply:
            raise RuntimeError(reply["error"])
        return reply

    def _once(self, samples, seed):
        self.process.stdin.write(
            json.dumps({"samples": samples, "seed": seed, "file": str(self.file)}) + "\n"
        )
        self.process.stdin.flush()
        return self._reply()

    def render(self, samples, seed):
        import numpy as np

        if not self.is_warm:  # compiles; the kernels do not depend on the number of samples
            self._once(1, seed)
            self.is_warm = True
        reply = self._once(samples, seed)
        return np.load(self.file), reply["seconds"], reply["samples"]

    def close(self):
        self.process.stdin.close()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()


# ---- Images


def read_exr(path):
    import numpy as np
    import OpenEXR

    channels = OpenEXR.File(str(path)).channels()
    if "RGB" in channels:
        return np.asarray(channels["RGB"].pixels)[..., :3]
    return np.stack([channels[c].pixels for c in "RGB"], -1)


def rel_mse(image, reference):
    import numpy as np

    i, r = image.astype(np.float64), reference.astype(np.float64)
    return float(np.mean((i - r) ** 2 / (r * r + 0.01 * np.mean(r) ** 2)))


# ---- The measurement


def samples_for(renderer, reference, target, residual, budget):
    """Two numbers of samples a pixel, powers of two, with errors above and below the target, as far as renders of
    `budget` seconds reach it. Low-discrepancy samples are only at their best in powers of two.
    """
    errors, samples = {}, 4
    while samples not in errors:
        image, seconds, _ = renderer.render(samples, 1000 + len(errors))
        errors[samples] = error = max(rel_mse(image, reference) - residual, 1e-9)
        steps = math.log2(error / target)
        steps = math.ceil(steps) if steps > 0 else math.floor(steps)
        following = 2 ** max(0, math.log2(samples) + min(steps, 4))
        if samples > 1 and following > samples and seconds * following / samples > budget:
            following = samples
        if error <= target and samples // 2 in errors and errors[samples // 2] > target:
            break
        samples = int(following)
    above = [n for n in errors if errors[n] > target]
    upper = min((n for n in errors if errors[n] <= target), default=max(errors))
    return sorted({max(above, default=max(1, upper // 2)), upper})


def measure(renderers, reference, target, residual, repeats, budget):
    """{renderer: {samples: [(seconds, error, samples done, bias of the mean)]}}, and {renderer: why it failed}."""
    samples, failed = {}, {}
    for r in renderers:
        try:
            samples[r] = samples_for(r, reference, target, residual, budget)
        except RuntimeError as e:
            failed[r] = str(e)
    rows = {r: {n: [] for n in samples[r]} for r in samples}
    for i in range(repeats):
        for r in [r for r in samples if r not in failed]:
            try:
                for n in samples[r]:
                    image, seconds, done = r.render(n, 2000 + i)
                    error = rel_mse(image, reference) - residual
                    rows[r][n].append((seconds, error, done, image.mean() / reference.mean() - 1))
                    note(f"  {r.name}: {done:.0f} samples, {seconds:.2f} s, relMSE {error:.5f}")
            except RuntimeError as e:
                failed[r] = str(e)
    return {r: rows[r] for r in rows if r not in failed}, failed


def to_error(points, target):
    """Samples at which a power law through two points (samples, error) meets the target."""
    (n0, e0), (n1, e1) = points[0], points[-1]
    power = math.log(e0 / e1) / math.log(n1 / n0) if n1 != n0 and e0 > e1 else 1.0
    return n1 * (e1 / target) ** (1 / power)


def table(name, target, results, pixels, base):
    print(f"\n{name}: seconds to relMSE {target:g}")
    print(
        f"{'':<10}{'seconds':>9}{'samples':>9}{'M samples/s':>13}{'spread':>8}{'mean':>9}   time / Mitsuba's "
        "  measured"
    )
    median = statistics.median
    summary = {}
    for r, rows in results.items():
        points = [
            (median(done for _, _, done, _ in rows[n]), median(error for _, error, _, _ in rows[n]))
            for n in rows
        ]
        last = rows[max(rows)]
        speeds = [done * pixels / seconds / 1e6 for seconds, _, done, _ in last]
        needed = to_error(points, target)
        summary[r] = (
            needed * pixels / 1e6 / median(speeds),
            needed,
            median(speeds),
            (max(speeds) - min(speeds)) / median(speeds),
            statistics.mean(row[3] for row in last),
            points,
        )
    reference = next((summary[r][0] for r in summary if r.name == base), None)
    for r, (seconds, needed, speed, spread, bias, points) in summary.items():
        ratio = f"{seconds / reference:.2f}" if reference else "-"
        measured = ", ".join(f"{n:.0f} samples {e:.2g}" for n, e in points)
        print(
            f"{r.name:<10}{seconds:>9.2f}{needed:>9.0f}{speed:>13.3f}{spread:>8.0%}{bias:>+9.2%}  "
            f" {ratio:<16}   {measured}"
        )


def run(a):
    wanted = [n for n in ("mitsuba", "luxcore", "cycles") if n in a.peers]
    llvm = find_llvm() if "mitsuba" in wanted else None
    cores = ",".join(map(str, sorted(os.sched_getaffinity(0))[: a.threads]))
    if cores.count(",") + 1 < a.threads:
        note(f"only {cores.count(',') + 1} cores for {a.threads} threads")
    descriptions, lines = {}, []
    load = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as folder:
        for text in a.scene:
            name, _, error = text.partition("=")
            target, residual = SCENES.get(name, (0.01, 0.0))
            target = float(error) if error else target
            scene = Path(a.scenes) / name / "scene.gltf"
            reference = read_exr(scene.parent / "reference.exr")
            height, width = reference.shape[:2]
            note(f"{name}, {width} x {height}")
            renderers = []
            for start in [lambda: Etendue(a.etendue, scene, width, height, cores, Path(folder))] + [
                lambda n=n: Peer(
                    n,
                    scene,
                    width,
                    height,
                    cores,
                    Path(folder),
                    {"DRJIT_LIBLLVM_PATH": str(llvm)} if n == "mitsuba" and llvm else {},
                )
                for n in wanted
            ]:
                label = "étendue" if start.__defaults__ is None else start.__defaults__[0]
                try:
                    renderers.append(start())
                    descriptions[label] = renderers[-1].description
                except (RuntimeError, OSError) as e:
                    lines.append(f"{name}: no {label}: {e}")
            results, failed = measure(renderers, reference, target, residual, a.repeats, a.budget)
            lines += [f"{name}: {r.name} failed: {why}" for r, why in failed.items()]
            table(name, target, results, width * height, "mitsuba")
            for r in renderers:
                r.close()
    print(
        f"\n{a.threads} thread{'s' * (a.threads > 1)} on core{'s' * (a.threads > 1)} {cores}; load average"
        f" {load:.1f} before, {os.getloadavg()[0]:.1f} after; median of {a.repeats}"
    )
    print("\n".join(list(descriptions.values()) + lines))


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("scene", nargs="*", default=list(SCENES), metavar="SCENE[=ERROR]")
    parser.add_argument("--scenes", default=str(ROOT.parent / "shared" / "reference"), metavar="DIR")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--budget", type=float, default=120, metavar="SEC", help="longest single render; 120")
    parser.add_argument("--peers", default="mitsuba,luxcore,cycles", help="of mitsuba, luxcore, cycles; all")
    parser.add_argument("--etendue", default=str(ROOT / "build" / "release" / "etendue"), metavar="PATH")
    a = parser.parse_args()
    a.peers = [p for p in a.peers.split(",") if p]
    if unknown := set(a.peers) - set(PACKAGES):
        parser.error(f"no peer '{unknown.pop()}'; there are {', '.join(PACKAGES)}")
    if not Path(a.etendue).exists():
        parser.error(f"{a.etendue} is not there: build étendue, or name it with --etendue")
    for text in a.scene:
        folder = Path(a.scenes) / text.partition("=")[0]
        for file in ("scene.gltf", "reference.exr"):
            if not (folder / file).exists():
                parser.error(
                    f"{folder / file} is not there; --scenes names the folder of the scenes' folders"
                )
    # Images are read in an environment of the tool's own: this script runs again there.
    if Path(sys.prefix).resolve() != (PEERS / "tool").resolve():
        set_up(["tool", *a.peers])
        if not installed("tool"):
            sys.exit("numpy and OpenEXR could not be installed")
        os.execv(environment_for("tool"), [str(environment_for("tool")), *sys.argv])
    run(a)


if __name__ == "__main__":
    main()
