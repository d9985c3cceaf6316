#!/usr/bin/env python3
"""Error against time of étendue and of other renderers, on the same cores in one run.

    tools/compare_peers.py [-o DIR] [--time 30] [--threads 1] [--size WxH] [--peers A,B]
                           [--environment FILE.hdr] [SCENE.gltf …]

For every scene it runs `etendue bench` into DIR/NAME, then gives every engine of the peers the same time in the same
way: renders of 1, 2, 4, … samples a pixel, each with a seed of its own, in turn with the other engines, measured
against the same reference. Seconds are of rendering alone, without start, scene and compilation. The points join
DIR/NAME/bench.csv, and `etendue bench` draws the page again. The reference is `reference.exr` beside a scene called
scene.gltf, else one that étendue renders.

The peers come into Python environments under build/peers: Mitsuba 3 (with LLVM 19, unpacked from Debian's package),
LuxCore, Cycles (Blender's module). One that is missing, that cannot do a scene, or whose images have another mean, is a
note on the page and no failure.
"""

import argparse
import csv
import json
import math
import os
import re
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PEERS = ROOT / "build" / "peers"
PACKAGES = {"mitsuba": ["mitsuba"], "luxcore": ["pyluxcore"], "cycles": ["bpy"], "tool": ["pillow"]}
ENGINES = {  # peer: [(name in tables, engine)]
    "mitsuba": [("Mitsuba path", "path"), ("Mitsuba ptracer", "ptracer")],
    "luxcore": [(f"LuxCore {e}", e) for e in ("PATHCPU", "BIDIRCPU", "BIDIRVMCPU")],
    "cycles": [("Cycles", "path")],
}
# relMSE of references whose noise is known, by their folder's name
REFERENCES = {"cornell_rgb": 4.4e-4, "veach_mis": 2.0e-4, "furnace": 1.9e-5}
MEAN_TOLERANCE = 0.01  # beyond it, and beyond four standard errors, two renderers do not render the same


def note(text):
    print(text, file=sys.stderr, flush=True)


# ---- The environments


def environment_for(name):
    """Blender's module pins an old numpy: an environment a peer keeps them apart."""
    return PEERS / name / "bin" / "python"


def packages(name):
    return " ".join([*PACKAGES[name], "numpy", "OpenEXR"])


def installed(name):
    marker = PEERS / name / "installed"
    return marker.exists() and marker.read_text() == packages(name)


def set_up(names):
    for name in names:
        if installed(name):
            continue
        note(f"setting up {name} in {PEERS.relative_to(ROOT)}")
        PEERS.mkdir(parents=True, exist_ok=True)
        subprocess.run([sys.executable, "-m", "venv", PEERS / name], check=True)
        pip = [environment_for(name), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        done = subprocess.run([*pip, *packages(name).split()], capture_output=True, text=True)
        if done.returncode == 0:  # the last thing: an interrupted set-up is done again
            (PEERS / name / "installed").write_text(packages(name))
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


# ---- Renderers


def run_bench(a, cores, arguments, **options):
    command = ["taskset", "-c", cores, a.etendue, "bench", *map(str, arguments)]
    threads = {"LP_NUM_THREADS": str(cores.count(",") + 1)}
    before = signal.signal(
        signal.SIGINT, lambda *_: None
    )  # Ctrl-C is for the bench, which then ends by itself
    try:
        return subprocess.run(command, env=os.environ | threads, **options).returncode
    finally:
        signal.signal(signal.SIGINT, before)


class Engine:
    """One engine of a peer, in a process of its own."""

    def __init__(self, peer, name, engine, scene, size, cores, folder, defaults):
        if not installed(peer):
            raise RuntimeError("could not be installed")
        self.name, self.file = name, folder / "image.npy"
        llvm = find_llvm() if peer == "mitsuba" else None
        worker = ROOT / "tools" / "peers" / f"{peer}_worker.py"
        threads = cores.count(",") + 1
        words = [environment_for(peer), worker, scene, *size, threads, engine, *map(json.dumps, defaults)]
        self.process = subprocess.Popen(
            ["taskset", "-c", cores, *map(str, words)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            start_new_session=True,  # Ctrl-C is for this script
            env=os.environ | ({"DRJIT_LIBLLVM_PATH": str(llvm)} if llvm else {}),
        )
        ready = self._reply()
        self.description, self.least = ready["ready"], ready["least"]
        self.points, self.spent, self.renders, self.longest = [], 0.0, 0, None

    def _reply(self):
        line = self.process.stdout.readline()
        if not line:
            raise RuntimeError(f"ended with code {self.process.wait()}")
        reply = json.loads(line)
        if "error" in reply:
            raise RuntimeError(reply["error"])
        return reply

    def seconds(self, samples, seed):
        """Of rendering that, to `file`."""
        request = {"samples": samples, "seed": seed, "file": str(self.file)}
        self.process.stdin.write(json.dumps(request) + "\n")
        self.process.stdin.flush()
        return self._reply()["seconds"]

    def render(self, samples, seed):
        import numpy as np

        seconds = self.seconds(samples, seed)
        return np.load(self.file), seconds

    def close(self):
        if self.process.poll() is not None:
            return
        self.process.stdin.close()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()


# ---- The measurement, as `etendue bench` does it


def measure(engine, reference, samples, seed):
    import numpy as np

    image, seconds = engine.render(samples, seed + engine.renders)
    i, r = image.astype(np.float64), reference["image"].astype(np.float64)
    measured = float(np.mean((i - r) ** 2 / (r * r + 0.01 * np.mean(r) ** 2)))
    point = {
        "seed": seed + engine.renders,
        "passes": samples,
        "seconds": max(seconds, 1e-6),
        "relmse": measured - reference["relmse"],
        "relmse_measured": measured,
        "bias": float(i.mean() / r.mean() - 1),
    }
    engine.renders += 1
    engine.spent += point["seconds"]
    engine.points.append(point)
    if engine.longest is None or samples >= engine.longest[0]:
        engine.longest = samples, image
    note(
        f"{engine.name}: {samples} samples, {seconds:.3g} s, relMSE {point['relmse']:.3g}, bias {point['bias']:+.2%}"
    )


def measure_round(engine, reference, first, seconds, seed):
    """1, 2, 4, … samples; the first round leaves a quarter of the time to the others."""
    limit = 0.75 * seconds if first else seconds
    samples, following = engine.least, 0.0
    while (first and samples == engine.least) or engine.spent + following <= limit:
        before = engine.spent
        measure(engine, reference, samples, seed)
        following = 2 * (engine.spent - before)
        samples *= 2


def measure_all(engines, reference, seconds, seed):
    """Fills the engines' points, until interrupted; returns ({name: why it failed}, whether it was)."""
    failed = {}
    for turn in range(8):
        for engine in [e for e in engines if e.name not in failed]:
            try:
                if turn == 0:
                    engine.render(engine.least, seed)  # compiles
                if turn == 0 or engine.spent <= 0.9 * seconds:
                    measure_round(engine, reference, turn == 0, seconds, seed)
            except (RuntimeError, BrokenPipeError) as e:
                failed[engine.name] = str(e)
            except KeyboardInterrupt:
                note("stopping; what was measured so far is written")
                for other in engines:
                    other.process.kill()
                return failed | {e.name: "interrupted" for e in engines if not e.points}, True
    return failed, False


def mean_of_biases(points):
    """Mean and standard error, weighted by samples."""
    weight = sum(p["passes"] for p in points)
    mean = sum(p["passes"] * p["bias"] for p in points) / weight
    scatter = sum(p["passes"] * (p["bias"] - mean) ** 2 for p in points)
    return mean, math.sqrt(scatter / max(1, len(points) - 1) / weight)


# ---- Results


def read_exr(path):
    import numpy as np
    import OpenEXR

    channels = OpenEXR.File(str(path)).channels()
    if "RGB" in channels:
        return np.asarray(channels["RGB"].pixels)[..., :3]
    return np.stack([channels[c].pixels for c in "RGB"], -1)


def write_png(path, image, scale):
    import numpy as np
    from PIL import Image

    x = np.clip(image * scale, 0, 1)
    encoded = np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)  # sRGB
    Image.fromarray(np.round(encoded * 255).astype(np.uint8)).save(path)


def add_results(folder, scene, engines, failed, reference, notes):
    document = json.loads((folder / "bench.json").read_text(encoding="utf-8"))
    entry = next(s for s in document["scenes"] if s["name"] == scene)
    entry["notes"] += notes
    with open(folder / "bench.csv", "a", encoding="utf-8", newline="") as file:
        fields = open(folder / "bench.csv", encoding="utf-8").readline().strip().split(",")
        rows = csv.DictWriter(file, fields, restval=0, lineterminator="\n")
        for engine in engines:
            if engine.name in failed:
                entry["notes"].append(f"{engine.name}: failed: {failed[engine.name]}")
                continue
            bias, error = mean_of_biases(engine.points)
            if abs(bias) > MEAN_TOLERANCE + 4 * error:
                entry["notes"].append(
                    f"{engine.name}: not compared: its mean differs by {bias:+.2%} ± {error:.2%}"
                )
                continue
            entry["notes"].append(f"{engine.name}: {engine.description}")
            rows.writerows({"scene": scene, "algorithm": engine.name, **p} for p in engine.points)
            scale = 0.25 / reference["image"][..., 1].mean()
            write_png(folder / f"{scene}.{engine.name}.png", engine.longest[1], scale)
    (folder / "bench.json").write_text(json.dumps(document, indent=2, ensure_ascii=False), encoding="utf-8")


def default_view(a, scene):
    """The camera that étendue takes where a file has none: all of the scene from the front, a little above."""
    import numpy as np

    sys.path.insert(0, str(ROOT / "tools" / "peers"))
    import scene_data

    if scene_data.document(scene).get("cameras"):
        return None
    told = subprocess.run([a.etendue, "inspect", scene], capture_output=True, text=True).stdout
    found = re.search(r"sphere of radius (\S+) m around \(([^)]*)\)", told)
    if not found:
        return None
    radius, centre = float(found[1]), np.array([float(x) for x in found[2].split(",")])
    yfov, back = 0.6, np.array([0.35, 0.25, 1.0])
    back /= np.linalg.norm(back)
    right = np.cross([0, 1, 0], back)
    right /= np.linalg.norm(right)
    m = np.eye(4)
    m[:3] = np.stack([right, np.cross(back, right), back, centre + back * radius / math.sin(yfov / 2)], 1)
    return {"matrix": m.tolist(), "yfov": yfov}


def compare(a, scene, cores):
    name = scene.parent.name if scene.stem == "scene" else scene.stem
    folder = a.output / name
    folder.parent.mkdir(parents=True, exist_ok=True)
    arguments = [scene, "-o", folder, "--time", a.time, "--seed", a.seed, "--algorithms", a.algorithms]
    if a.size:
        arguments += ["--size", a.size]
    if a.environment:
        arguments += ["--environment", a.environment]
    defaults = [default_view(a, scene), a.environment and str(a.environment.resolve())]
    beside = scene.parent / "reference.exr"
    if scene.stem == "scene" and beside.exists():
        arguments += ["--reference", beside]
        if name in REFERENCES:
            arguments += ["--reference-relmse", REFERENCES[name]]
    load = os.getloadavg()[0]
    if code := run_bench(a, cores, arguments, stdout=subprocess.DEVNULL):
        sys.exit(code)
    entry = json.loads((folder / "bench.json").read_text(encoding="utf-8"))["scenes"][0]
    name, size = entry["name"], (entry["width"], entry["height"])
    reference = {"image": read_exr(folder / f"{name}.reference.exr"), "relmse": entry["reference_relmse"]}
    engines, notes = [], []
    with tempfile.TemporaryDirectory() as temporary:
        for peer in a.peers:
            for label, engine in ENGINES[peer]:
                own = Path(temporary) / label
                own.mkdir()
                try:
                    engines.append(Engine(peer, label, engine, scene, size, cores, own, defaults))
                except (RuntimeError, OSError) as e:
                    notes.append(f"{label}: left out: {e}")
                    note(notes[-1])
        failed, interrupted = measure_all(engines, reference, a.time, a.seed)
        for engine in engines:
            engine.close()
    notes.append(
        f"On core{'s' * (a.threads > 1)} {cores}; load average {load:.1f} before and {os.getloadavg()[0]:.1f} after."
    )
    add_results(folder, name, engines, failed, reference, notes)
    run_bench(a, cores, ["-o", folder])
    print(f"{folder / 'index.html'}\n", flush=True)
    if interrupted:
        sys.exit(130)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    default = ROOT / "scenes" / "cornell_box.gltf"
    parser.add_argument("scene", nargs="*", type=Path, default=[default], metavar="SCENE.gltf")
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "out" / "peers", metavar="DIR")
    parser.add_argument("--time", type=float, default=30, metavar="SEC", help="for each engine; 30")
    parser.add_argument("--threads", type=int, default=1, metavar="N", help="1")
    parser.add_argument("--size", metavar="WxH", help="the reference's, else as for `etendue render`")
    parser.add_argument("--environment", type=Path, metavar="FILE.hdr", help="as for `etendue render`")
    parser.add_argument("--seed", type=int, default=0, metavar="N")
    parser.add_argument(
        "--algorithms", default="backward,forward,bidirectional", metavar="A,B", help="of étendue"
    )
    parser.add_argument(
        "--peers", default=",".join(ENGINES), metavar="A,B", help="of mitsuba, luxcore, cycles; all"
    )
    parser.add_argument("--etendue", default=str(ROOT / "build" / "release" / "etendue"), metavar="PATH")
    a = parser.parse_args()
    a.peers = [p for p in a.peers.split(",") if p]
    if unknown := set(a.peers) - set(ENGINES):
        parser.error(f"no peer '{unknown.pop()}'; there are {', '.join(ENGINES)}")
    if not a.time > 0:
        parser.error("--time must be above 0")
    if not Path(a.etendue).exists():
        parser.error(f"{a.etendue} is not there: build étendue, or name it with --etendue")
    for scene in a.scene:
        if not scene.exists():
            parser.error(f"{scene} is not there")
    # Images are read in an environment of the tool's own: this script runs again there.
    if Path(sys.prefix).resolve() != (PEERS / "tool").resolve():
        set_up(["tool", *a.peers])
        if not installed("tool"):
            sys.exit("numpy, OpenEXR and pillow could not be installed")
        os.execv(environment_for("tool"), [str(environment_for("tool")), *sys.argv])
    cores = ",".join(map(str, sorted(os.sched_getaffinity(0))[: a.threads]))
    if cores.count(",") + 1 < a.threads:
        note(f"only {cores.count(',') + 1} cores for {a.threads} threads")
    for scene in a.scene:
        compare(a, scene, cores)


if __name__ == "__main__":
    main()
