#!/usr/bin/env python3
"""Packs a text of places of a microstructure's elements (scenes/FORMAT.md, "Places from a file").

    tools/pack_places.py dots.txt dots.bin --size 0.4x0.25 --radius 3e-5

SIZE is that of the sheet, m, RADIUS the elements'; cells are 3 to 64 times as wide. Ridges want --rows 1.
"""

import argparse
import math
import struct
from array import array


def read(path):
    for number, line in enumerate(open(path, encoding="utf-8-sig"), 1):
        words = line.split("#")[0].split()
        if not words:
            continue
        try:
            x, y, size, angle = [float(w) for w in words] + [1.0, 0.0][len(words) - 2 :]
        except ValueError:
            raise SystemExit(f"{path}: line {number}: allowed: x y [size] [angle]")
        yield number, x, y, size, angle


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("text")
    parser.add_argument("packed")
    parser.add_argument("--size", required=True, help="WxH of the sheet, m")
    parser.add_argument("--radius", required=True, type=float, help="of the elements, m")
    parser.add_argument("--rows", type=int, help="of cells; as many as fit unless given")
    options = parser.parse_args()
    width, height = (float(v) for v in options.size.split("x"))
    places = list(read(options.text))
    if not places:
        raise SystemExit(f"{options.text}: there are no elements")
    cell = max(min(math.sqrt(width * height / len(places)), 64 * options.radius), 2.9 * options.radius)
    columns, rows = max(1, int(width / cell)), options.rows or max(1, int(height / cell))
    entries = []
    for number, x, y, size, angle in places:
        u, v = (x / width + 0.5) * columns, (y / height + 0.5) * rows
        if not (0 <= u <= columns and 0 <= v <= rows and 0 < size <= 1):
            raise SystemExit(f"{options.text}: line {number}: ({x:g}, {y:g}), size {size:g}, is not on the sheet, or its size not in (0, 1]")
        column, row = min(int(u), columns - 1), min(int(v), rows - 1)
        parts = [min(int((a - b) * 65536), 65535) for a, b in ((u, column), (v, row))]
        entries.append((row * columns + column, *parts, max(round(size * 65536) - 1, 0), round(angle / (2 * math.pi) * 65536) % 65536))
    entries.sort()
    starts, at = array("I"), 0
    for i in range(columns * rows + 1):
        while at < len(entries) and entries[at][0] < i:
            at += 1
        starts.append(at)
    numbers = array("H", (n for e in entries for n in e[1:]))
    with open(options.packed, "wb") as out:
        out.write(b"ETDPLACE" + struct.pack("<4I", 1, columns, rows, len(entries)) + starts.tobytes() + numbers.tobytes())


if __name__ == "__main__":
    main()
