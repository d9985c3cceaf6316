#!/usr/bin/env python3
"""Rays a second through a light guide with 10^4 to 10^8 dents of the same cover, and what they take of memory.

    tools/bench_microstructure.py [--program FILE] [--rounds N] [--plot FILE.svg] [--files]

All counts in one run, in turn, by forward rays into a meter before the guide; ratios are to 10^4. The plot needs gnuplot. With --files
dents stand where packed files say (scenes/FORMAT.md), of which the largest has 1.2 GB.
"""

import argparse
import json
import random
import struct
import subprocess
import sys
import tempfile
from array import array
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tools" / "scenes"))
from elements import guide_scene  # noqa: E402

COUNTS = [10**n for n in range(4, 9)]
WIDTH, HEIGHT = 0.4, 0.25  # of the guide, m


def write_places(path, count):
    """About as many places, in cells of one each, jittered and of many sizes; returns the side of a cell."""
    columns = round((WIDTH / HEIGHT * count) ** 0.5)
    rows = round(count / columns)
    pick = random.Random(1)
    block = array("H")
    for _ in range(1 << 16):
        block.extend((pick.randrange(20000, 45000), pick.randrange(20000, 45000), pick.randrange(40000, 65536), pick.randrange(65536)))
    with open(path, "wb") as out:
        out.write(b"ETDPLACE" + struct.pack("<4I", 1, columns, rows, columns * rows))
        for first in range(0, columns * rows + 1, 1 << 20):
            array("I", range(first, min(first + (1 << 20), columns * rows + 1))).tofile(out)
        for first in range(0, columns * rows, 1 << 16):
            block[: 4 * min(1 << 16, columns * rows - first)].tofile(out)
    return WIDTH / columns


def place_by_file(scene, places, cell):
    """Dents of the scene stand where the file says, as large as these cells allow."""
    document = json.loads(scene.read_text())
    for node in document["nodes"]:
        sheet = node.get("extensions", {}).get("ETD_optics", {}).get("geometry", {})
        if sheet.get("class") == "microstructure":
            for name in ("pitch", "density", "seed"):
                sheet.pop(name, None)
            sheet.update(placement={"file": places.name}, radius=0.1 * cell, depth=0.033 * cell)
    scene.write_text(json.dumps(document))


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
    parser.add_argument("--files", action="store_true")
    options = parser.parse_args()
    speeds, memory, lit, setup = ({n: [] for n in COUNTS} for _ in range(4))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for count in COUNTS:
            guide_scene("guide", (WIDTH * HEIGHT / count) ** 0.5, "A guide.").write(folder / f"{count}.gltf")
            if options.files:
                places = folder / f"{count}.places"
                place_by_file(folder / f"{count}.gltf", places, write_places(places, count))
            measure(options.program, folder / f"{count}.gltf", folder)  # compiles its kernels
        for _ in range(options.rounds):
            for count in COUNTS:
                s = measure(options.program, folder / f"{count}.gltf", folder)
                setup[count].append(s["setup_seconds"])
                speeds[count].append(s["rays_per_second"])
                memory[count].append(s["peak_device_memory_bytes"] / 2**20)
                lit[count].append(s["power_balance"]["lost"]["escaped"])
    base = max(speeds[COUNTS[0]])
    print("dents        million rays/s   of 10^4   MiB on the device   leaves the guide, lm of 100   s of set-up")
    rows = []
    for n in COUNTS:
        best = max(speeds[n])
        rows.append(f"{n} {best}")
        print(f"{n:<12} {best / 1e6:14.3f} {best / base:9.3f} {max(memory[n]):19.1f} {lit[n][-1]:20.2f} {min(setup[n]):20.2f}")
    if options.plot:
        script = "set terminal svg; set logscale x; set yrange [0:*]; set xlabel 'dents'; set ylabel 'rays/s'\n"
        script += "plot '-' with linespoints pointtype 7 notitle\n" + "\n".join(rows) + "\ne\n"
        subprocess.run(["gnuplot"], input=script.encode(), stdout=options.plot.open("wb"), check=True)


if __name__ == "__main__":
    main()
