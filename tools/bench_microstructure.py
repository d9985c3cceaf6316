#!/usr/bin/env python3
"""Rays a second through a light guide with 10^4 to 10^8 dents of the same cover, and what they take of memory.

    tools/bench_microstructure.py [--program FILE] [--rounds N] [--plot FILE.svg]

All counts in one run, in turn, by forward rays into a meter before the guide; ratios are to 10^4. The plot needs gnuplot.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tools" / "scenes"))
from elements import guide_scene  # noqa: E402

COUNTS = [10**n for n in range(4, 9)]
WIDTH_TIMES_HEIGHT = 0.4 * 0.25  # m², of the guide


def measure(program, scene, folder):
    stats = folder / "stats.json"
    command = [program, "render", scene, "-o", folder / "out.exr", "--receiver", "front", "--algorithm", "forward", "--color", "rgb"]
    subprocess.run([*command, "--forward-paths", "1000", "--passes", "8", "--stats", stats, "-q"], check=True)
    return json.loads(stats.read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=ROOT / "build" / "release" / "etendue")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--plot", type=Path)
    options = parser.parse_args()
    speeds, memory, lit = ({n: [] for n in COUNTS} for _ in range(3))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for count in COUNTS:
            guide_scene("guide", (WIDTH_TIMES_HEIGHT / count) ** 0.5, "A guide.").write(folder / f"{count}.gltf")
            measure(options.program, folder / f"{count}.gltf", folder)  # compiles its kernels
        for _ in range(options.rounds):
            for count in COUNTS:
                s = measure(options.program, folder / f"{count}.gltf", folder)
                speeds[count].append(s["rays_per_second"])
                memory[count].append(s["peak_device_memory_bytes"] / 2**20)
                lit[count].append(s["power_balance"]["lost"]["escaped"])
    base = max(speeds[COUNTS[0]])
    print("dents        million rays/s   of 10^4   MiB on the device   leaves the guide, lm of 100")
    rows = []
    for n in COUNTS:
        best = max(speeds[n])
        rows.append(f"{n} {best}")
        print(f"{n:<12} {best / 1e6:14.3f} {best / base:9.3f} {max(memory[n]):19.1f} {lit[n][-1]:20.2f}")
    if options.plot:
        script = "set terminal svg; set logscale x; set yrange [0:*]; set xlabel 'dents'; set ylabel 'rays/s'\n"
        script += "plot '-' with linespoints pointtype 7 notitle\n" + "\n".join(rows) + "\ne\n"
        subprocess.run(["gnuplot"], input=script.encode(), stdout=options.plot.open("wb"), check=True)


if __name__ == "__main__":
    main()
