#!/usr/bin/env python3
"""How long merging takes once the workers are done: all parts by one machine, or by the workers themselves in a tree.

    tools/cluster/simulate_tree.py [--workers 1000] [--fan 8]

Machines finish at times that vary by a tenth around the same moment. A machine fetches one part after the other over its own link, and
adds each as it comes; a part of a node of the tree is ready once its machine has added all of its own. Costs are those measured on parts
of 4 megapixels (README.md): 832 MB a part, 1.2 s to add one, 2.9 s for the image.
"""
import argparse, random


def merged(ready, begin, fetch, add):
    """When a machine that is free from `begin` on has fetched and added the parts that are ready at these times."""
    fetched = added = begin
    for time in sorted(ready):
        fetched = max(fetched, time) + fetch
        added = max(added, fetched) + add
    return added


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--workers", type=int, default=1000)
    parser.add_argument("--fan", type=int, default=8, help="parts of a node of the tree")
    parser.add_argument("--megabytes", type=float, default=832, help="of a part")
    parser.add_argument("--link", type=float, default=1000, help="megabytes a second")
    parser.add_argument("--add", type=float, default=1.2, help="seconds of a core to add a part")
    parser.add_argument("--image", type=float, default=2.9, help="seconds for the image")
    parser.add_argument("--render", type=float, default=600, help="seconds that the workers render")
    parser.add_argument("--seed", type=int, default=1)
    a = parser.parse_args()
    random.seed(a.seed)
    done = [a.render * random.uniform(0.95, 1.05) for _ in range(a.workers)]
    fetch, last = a.megabytes / a.link, max(done)
    one = merged(done, 0, fetch, a.add) + a.image
    print(f"{a.workers} workers, the last is done at {last:.0f} s")
    print(f"one machine for all: the image {one - last:.0f} s later")
    level, parts = 0, done
    while len(parts) > 1:
        # In order of readiness, so that nobody waits for the slow; a node's machine is the worker of its last part.
        parts.sort()
        groups = [parts[i:i + a.fan] for i in range(0, len(parts), a.fan)]
        parts = [merged(group[:-1], group[-1], fetch, a.add) if len(group) > 1 else group[0] for group in groups]
        level += 1
        print(f"tree of {a.fan}, level {level}: {len(parts)} parts left, {max(parts) - last:.0f} s later")
    print(f"tree of {a.fan}: the image {parts[0] + a.image - last:.0f} s later")


if __name__ == "__main__":
    main()
