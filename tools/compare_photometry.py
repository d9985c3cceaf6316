#!/usr/bin/env python3
"""Speed of measuring light, against programs that do, on one core in one run.

    tools/compare_photometry.py [--passes 16] [--only rays|office]

Forward paths a second into an intensity meter, from a Lambertian lamp in a white box that is open above, and in the same
box with a ball lens: étendue, Mitsuba's `ptracer` (into a camera that looks into the box) and, in the box alone,
eulumdat-goniosim (a crate; `cargo` is needed). All paths go on until they leave or are absorbed; roulette is each program's own.

Time to 1 % of illuminance on the desks of scenes/office.gltf: étendue, and Radiance's `rtrace -I` at the same points, by pure Monte
Carlo and with its cache, at the settings that come to 1 % first. Each is measured against its own converged values, whose
means are told: Radiance's panels do not reflect. Times of whole processes, with what they cache on disk warm.

What is missing or cannot be installed is a line, and no failure.
"""

import argparse
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tools" / "scenes")]

import compare_peers as peers
from gltf_builder import Gltf, facing

CORE = "0"
ETENDUE = ROOT / "build" / "release" / "etendue"


def run(command, **options):
    return subprocess.run(
        ["taskset", "-c", CORE, *map(str, command)],
        env=os.environ | {"LP_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        check=True,
        **options,
    ).stdout


# ---- Rays a second


def box(name, lens, meter):
    s = Gltf(name, "A Lambertian lamp in a white box that is open above.")
    white = s.surface("white", "lambertian", reflectance=0.9)
    h = 0.1
    s.quad("floor", white, [[-h, 0, h], [h, 0, h], [h, 0, -h], [-h, 0, -h]])
    for x, z in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        a, b = ([h * x - h * z, h * z + h * x], [h * x + h * z, h * z - h * x])
        s.quad("wall", white, [[b[0], 0, b[1]], [a[0], 0, a[1]], [a[0], 2 * h, a[1]], [b[0], 2 * h, b[1]]])
    lamp, e = s.emitter("lamp", 1000 / (math.pi * 0.05**2)), 0.025
    s.quad("lamp", lamp, [[-e, 0.001, e], [e, 0.001, e], [e, 0.001, -e], [-e, 0.001, -e]])
    if lens:
        s.medium("glass", ior=1.5168)
        s.shape("lens", "sphere", s.surface("glass", "dielectric", inside="glass"), [0, 0.08, 0], radius=0.03)
    if meter:
        s.receiver("far", facing([0, 0, 0], [0, 0, 1]), "intensity", resolution=[90, 91])
    s.camera([0, 1, 0.001], [0, 0, 0], 40, 1)
    return s


def etendue_paths(scene, passes):
    stats = scene.with_suffix(".json")
    words = ["render", scene, "--receiver", "far", "--algorithm", "forward", "--forward-paths", 64, "--quiet"]
    run([ETENDUE, *words, "--passes", passes, "--stats", stats, "-o", scene.with_suffix(".exr")])
    s = json.loads(stats.read_text())
    return s["forward_paths"] / s["seconds"], s["forward_rays"] / s["forward_paths"]


def mitsuba_paths(scene, folder):
    peers.set_up(["mitsuba"])
    engine = peers.Engine("mitsuba", "ptracer", "ptracer", scene, (256, 256), CORE, folder, (None, None))
    engine.seconds(1, 1)  # compiles
    samples = 64
    seconds = engine.seconds(samples, 2)
    engine.close()
    return samples * 256 * 256 / seconds


def goniosim_photons():
    if not shutil.which("cargo"):
        raise RuntimeError("needs cargo")
    target = peers.PEERS / "goniosim"
    source = ROOT / "tools" / "peers" / "goniosim"
    subprocess.run(
        ["cargo", "build", "--release", "--quiet", "--manifest-path", source / "Cargo.toml", "--target-dir", target],
        check=True,
        capture_output=True,
    )
    photons = 4_000_000
    seconds, _ = map(float, run([target / "release" / "photon_rate", photons]).split())
    return photons / seconds


def compare_rays(passes, folder):
    for name, lens in (("box", False), ("box with a ball lens", True)):
        scene, seen = folder / "metered.gltf", folder / "seen.gltf"
        box(name, lens, True).write(scene)
        box(name, lens, False).write(seen)
        etendue_paths(scene, 1)  # compiles
        rate, length = etendue_paths(scene, passes)
        print(f"{name}: étendue {rate / 1e6:.3g} million paths/s, {rate * length / 1e6:.3g} million rays/s")
        others = [("Mitsuba ptracer", lambda: mitsuba_paths(seen, folder))]
        if not lens:
            others.append(("eulumdat-goniosim", goniosim_photons))
        for other, measure in others:
            try:
                theirs = measure()
                print(f"{name}: {other} {theirs / 1e6:.3g} million paths/s; étendue is {rate / theirs:.2f} times as fast")
            except (RuntimeError, subprocess.CalledProcessError) as e:
                print(f"{name}: {other}: {str(e).splitlines()[0]}")


# ---- The office


def desk_points(columns=16, rows=12):
    """Middles of the meter's pixels, of scenes/office.gltf, x and z."""
    return [(4 * ((c + 0.5) / columns - 0.5), 3 * ((r + 0.5) / rows - 0.5)) for r in range(rows) for c in range(columns)]


def radiance_scene(folder, programs):
    """Of scenes/office.gltf: x, -z, y. Its materials by name."""
    lines = ["void light unused 0 0 3 1 1 1"]
    for name, rgb in (("ceiling", [0.7] * 3), ("wall", [0.5] * 3), ("floor", [0.2] * 3), ("desk", [0.42, 0.33, 0.22])):
        lines.append(f"void plastic {name} 0 0 5 {rgb[0]} {rgb[1]} {rgb[2]} 0 0")
    a, b, h = 2.5, 2, 2.8

    def polygon(material, corners):
        flat = " ".join(f"{v:g}" for c in corners for v in c)
        lines.append(f"{material} polygon p{len(lines)} 0 0 {3 * len(corners)} {flat}")

    def block(material, x0, x1, y0, y1, z0, z1):
        for axis in range(3):
            for side in (0, 1):
                lo, hi = [x0, y0, z0], [x1, y1, z1]
                u, v = (axis + 1) % 3, (axis + 2) % 3
                corners = []
                for s, t in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    c = [0, 0, 0]
                    c[axis], c[u], c[v] = (hi if side else lo)[axis], (hi if s else lo)[u], (hi if t else lo)[v]
                    corners.append(c)
                yield axis, side, corners if side else corners[::-1]

    for axis, side, corners in block("", -a, a, -b, b, 0, h):
        polygon("wall" if axis < 2 else ("ceiling" if side else "floor"), corners[::-1])
    for x in (-1.25, 1.25):
        for _, _, corners in block("", x - 0.8, x + 0.8, 0.0, 0.8, 0, 0.72):
            polygon("desk", corners)
    text = (ROOT / "scenes" / "office.ldt").read_text("latin-1").splitlines()
    count = int(text[5])
    angles, candela = text[-2 * count : -count], [float(v) * 3.4 for v in text[-count:]]
    ies = f"IES:LM-63-2002\nTILT=NONE\n1 -1 1 {count} 1 1 2 0.6 0.6 0\n1 1 30\n"
    (folder / "panel.ies").write_text(ies + " ".join(angles) + "\n0\n" + " ".join(f"{v:.6g}" for v in candela) + "\n")
    run([programs / "ies2rad", "-o", folder / "panel", folder / "panel.ies"], cwd=folder)
    for x in (-1.25, 1.25):
        for y in (-1, 1):
            lines.append(f"!{programs}/xform -t {x} {y} 2.795 {folder}/panel.rad")
    (folder / "office.rad").write_text("\n".join(lines) + "\n")
    tree = folder / "office.oct"
    with open(tree, "wb") as out:
        subprocess.run([programs / "oconv", folder / "office.rad"], stdout=out, check=True, stderr=subprocess.DEVNULL)
    return tree


def radiance_lux(tree, programs, settings):
    points = "".join(f"{x} {-z} 0.75 0 0 1\n" for x, z in desk_points())
    start = time.perf_counter()
    text = run([programs / "rtrace", "-I+", "-h", *settings, tree], input=points)
    seconds = time.perf_counter() - start
    rows = [[float(w) for w in line.split()] for line in text.splitlines() if line.strip()]
    return [179 * (0.265 * r + 0.670 * g + 0.065 * b) for r, g, b in rows], seconds


def etendue_lux(passes, seed, folder):
    start = time.perf_counter()
    words = ["measure", ROOT / "scenes" / "office.gltf", "--receivers", "desks", "--quiet", "--seed", seed]
    run([ETENDUE, *words, "--passes", passes, "-o", folder / "desks"])
    seconds = time.perf_counter() - start
    rows = (folder / "desks" / "desks.csv").read_text().splitlines()[1:]
    return [float(row.split(",")[6]) for row in rows], seconds


def rms(values, right):
    return math.sqrt(sum((v / r - 1) ** 2 for v, r in zip(values, right)) / len(right))


def compare_office(folder):
    right, _ = etendue_lux(1 << 16, 99, folder)
    for passes in (1 << k for k in range(4, 16)):
        values, seconds = etendue_lux(passes, 1, folder)
        if rms(values, right) <= 0.01:
            break
    print(f"office: étendue {100 * rms(values, right):.2g} % after {passes} passes, {seconds:.2f} s; mean {sum(right) / 192:.1f} lx")
    done = subprocess.run(
        [sys.executable, "-m", "venv", peers.PEERS / "radiance"], capture_output=True
    ).returncode or subprocess.run(
        [peers.environment_for("radiance"), "-m", "pip", "install", "--quiet", "pyradiance"], capture_output=True
    ).returncode
    found = next((peers.PEERS / "radiance").rglob("bin/rtrace"), None)
    if done or not found:
        print("office: Radiance: pyradiance cannot be installed")
        return
    programs = found.parent
    os.environ["RAYPATH"] = f".:{programs.parent / 'lib'}"
    tree = radiance_scene(folder, programs)
    common = ["-ab", "8", "-lw", "1e-5", "-ds", "0.05", "-dj", "0.7", "-dt", "0", "-dc", "1"]
    right_there, _ = radiance_lux(tree, programs, [*common, "-aa", "0", "-ad", "32768"])
    print(f"office: Radiance's converged mean {sum(right_there) / 192:.1f} lx")
    ways = {
        "Monte Carlo": [[*common, "-aa", "0", "-ad", str(1 << k)] for k in range(4, 15)],
        "cache": [
            [*common, "-aa", aa, "-ar", "64", "-ad", str(1 << k), "-as", str(1 << (k - 2))]
            for aa in ("0.2", "0.1")
            for k in range(8, 12)
        ],
    }
    for name, tries in ways.items():
        best = None
        for settings in tries:
            values, theirs = radiance_lux(tree, programs, settings)
            if rms(values, right_there) <= 0.01 and (best is None or theirs < best):
                best = theirs
            if best is not None and name == "Monte Carlo":
                break
        if best is None:
            print(f"office: Radiance, {name}: not within 1 % at any setting tried")
        else:
            print(f"office: Radiance, {name}: 1 % in {best:.2f} s; étendue is {best / seconds:.2f} times as fast")


def main():
    parser = argparse.ArgumentParser(description=re.split("\n\n", __doc__)[0], epilog=__doc__)
    parser.add_argument("--passes", type=int, default=16, help="of étendue's forward rays")
    parser.add_argument("--only", choices=["rays", "office"])
    a = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        if a.only != "office":
            compare_rays(a.passes, Path(folder))
        if a.only != "rays":
            compare_office(Path(folder))


if __name__ == "__main__":
    main()
