"""The scenes in which `etendue classes --html` shows the classes: one an interface, called as the interface. The program puts the
example of a class into them: lists end to end, so that an example's materials, nodes and so on follow those here."""

import json
import math
import struct

from gltf_builder import Gltf, facing, look_at


def showcase(name):
    s = Gltf(name, "")
    s.environment = {"class": "image", "file": "sky.hdr", "scale": 0.7}
    return s


def tiles(scene, count, size):
    """A floor of count x count light and dark squares around the origin; materials 0 and 1."""
    for odd, reflectance in enumerate((0.62, 0.16)):
        material = scene.surface("dark tiles" if odd else "light tiles", "lambertian", reflectance=reflectance)
        positions, triangles = [], []
        for i in range(count):
            for k in range(count):
                if (i + k) % 2 == odd:
                    x, z, first = (i - count / 2) * size, (k - count / 2) * size, len(positions)
                    positions += [[x, 0, z + size], [x + size, 0, z + size], [x + size, 0, z], [x, 0, z]]
                    triangles += [[first, first + 1, first + 2], [first, first + 2, first + 3]]
        scene.mesh("dark tiles" if odd else "light tiles", material, positions, triangles)


def ball(name):
    """A ball of the example's material, the third, on tiles under the sky."""
    s = showcase(name)
    tiles(s, 20, 0.4)
    s.shape("ball", "sphere", 2, [0, 0.5, 0], radius=0.5)
    s.camera([0.6, 1.4, 3.6], [0, 0.45, 0], 23, 1)
    return s


def geometry():
    """The example stands on a grey floor; material 1 is for it."""
    s = showcase("geometry")
    grey = s.surface("floor", "lambertian", reflectance=0.5)
    s.surface("blue clay", "lambertian", reflectance=[0.09, 0.22, 0.42])
    s.shape("floor", "rectangle", grey, matrix=facing([0, 0, 0], [0, 1, 0], [0, 0, -1]), size=[12, 12])
    s.camera([0.9, 1.5, 3.1], [0, 0.42, 0], 25, 1)
    return s


def light():
    """A corner with a ball and a box, lit by the example alone."""
    s = Gltf("light", "")
    white = s.surface("white", "lambertian", reflectance=0.7)
    s.quad("floor", white, [[-1.2, 0, 1.2], [1.2, 0, 1.2], [1.2, 0, -1.2], [-1.2, 0, -1.2]])
    s.quad("wall", white, [[-1.2, 0, -1.2], [1.2, 0, -1.2], [1.2, 2.2, -1.2], [-1.2, 2.2, -1.2]])
    s.shape("ball", "sphere", white, [-0.35, 0.28, 0.25], radius=0.28)
    s.box("box", white, [0.45, 0.75, 0.45], translation=[0.4, 0, -0.3], rotation=[0, 0.216, 0, 0.976])
    s.camera([0.6, 1.6, 4.6], [0, 0.85, 0], 30, 1)
    return s


def phase():
    """Six beams through a ball of the example's medium, "fog", all around a small ball that they end at."""
    s = Gltf("phase", "")
    border = s.surface("border of the fog", "boundary", inside="fog")
    black = s.surface("black", "lambertian", outside="fog", reflectance=0.01)
    s.shape("fog", "sphere", border, radius=1)
    s.shape("ball", "sphere", black, radius=0.12)
    s.lights.append(
        {"name": "beam", "type": "spot", "intensity": 320, "spot": {"innerConeAngle": 0.03, "outerConeAngle": 0.035}}
    )
    s.extensions.add("KHR_lights_punctual")
    for i in range(6):
        a = math.pi * (i + 0.25) / 3
        s.nodes.append(
            {
                "name": f"beam {i}",
                "matrix": look_at([3 * math.cos(a), 0, 3 * math.sin(a)], [0, 0, 0]),
                "extensions": {"KHR_lights_punctual": {"light": 0}},
            }
        )
    s.camera([0, 2.4, 3.6], [0, 0, 0], 27, 1)
    return s


def receiver():
    """Two rows of pillars on tiles; the example looks at them."""
    s = showcase("receiver")
    tiles(s, 20, 0.5)
    stone = s.surface("stone", "lambertian", reflectance=[0.55, 0.28, 0.18])
    for row in range(5):
        for x in (-0.75, 0.75):
            s.box(f"pillar {row}", stone, [0.3, 1.4, 0.3], translation=[x, 0, 1 - 1.25 * row])
    return s


def sky():
    """Blue above, bright at the horizon, grey below, and a wide sun: radiance in latitude and longitude, as .hdr."""
    width, height = 96, 48
    sun = (-0.5, 0.64, 0.58)
    data = bytearray()
    for row in range(height):
        for column in range(width):
            polar, azimuth = math.pi * (row + 0.5) / height, 2 * math.pi * (column + 0.5) / width
            direction = (-math.sin(polar) * math.sin(azimuth), math.cos(polar), math.sin(polar) * math.cos(azimuth))
            up = direction[1]
            t = math.sqrt(up) if up > 0 else math.exp(30 * up)
            color = [0.85 - 0.6 * t, 0.92 - 0.5 * t, 1.0 - 0.22 * t] if up > 0 else [0.58 + 0.27 * t, 0.62 + 0.3 * t, 0.68 + 0.32 * t]
            angle = math.acos(min(1.0, sum(a * b for a, b in zip(direction, sun)) / math.hypot(*sun)))
            glow = 22 * math.exp(-0.5 * (angle / math.radians(8)) ** 2)
            color = [c + glow * s for c, s in zip(color, (1, 0.93, 0.8))]
            exponent = math.frexp(max(color))[1]
            data += bytes([*(min(255, int(c * 2.0 ** (8 - exponent))) for c in color), exponent + 128])
    return f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode() + bytes(data)


def paint():
    """A lacquer whose colour turns from violet to green where it is seen at a slant, as a table of its BSDF, 1/sr."""
    theta_i, theta_r = list(range(0, 81, 10)), list(range(0, 91, 10))
    phi = list(range(0, 181, 15))

    def value(i, r, p):
        i, r, p = math.radians(i), math.radians(r), math.radians(p)
        a, b = (math.sin(i), 0, math.cos(i)), (math.sin(r) * math.cos(p), math.sin(r) * math.sin(p), math.cos(r))
        half = [x + y for x, y in zip(a, b)]
        length = math.hypot(*half)
        flop = (math.sin(i) ** 2 + math.sin(r) ** 2) / 2
        lobe = 0.5 * math.exp(-((math.acos(min(1.0, half[2] / length)) / 0.3) ** 2)) if length > 0 else 0
        colors = ((0.16, 0.02, 0.30), (0.02, 0.30, 0.10))
        return [round(x + (y - x) * flop + lobe * (0.2 + x + y), 4) for x, y in zip(*colors)]

    table = {"description": "lacquer, violet to green: made by a formula"}
    table |= {"theta_i": theta_i, "theta_r": theta_r, "phi": phi}
    table["reflection"] = [[[value(i, r, p) for p in phi] for r in theta_r] for i in theta_i]
    return json.dumps(table, separators=(",", ":")).encode() + b"\n"


SHOWCASES = [geometry, light, receiver, lambda: ball("surface"), lambda: ball("medium"), phase]
def rough_gold():
    """A table of Mueller matrices in the format of Baek et al. 2020: facets of gold (Fresnel's equations with the indices of
    Johnson & Christy 1972 at 450, 550 and 650 nm) whose slopes are GGX's with alpha 0.4, without shadowing."""
    indices = {450: 1.38 + 1.92j, 550: 0.42 + 2.44j, 650: 0.17 + 3.15j}
    phi, theta_d, theta_h = ([end * i / (count - 1) for i in range(count)]
                             for end, count in ((2 * math.pi, 3), (math.pi / 2, 5), (math.pi / 2, 11)))

    def matrix(index, d, h):
        cosine, inside = math.cos(d), (index * index - math.sin(d) ** 2) ** 0.5
        s = (cosine - inside) / (cosine + inside)
        p = (index * index * cosine - inside) / (index * index * cosine + inside)
        even, odd, cross = (abs(s) ** 2 + abs(p) ** 2) / 2, (abs(s) ** 2 - abs(p) ** 2) / 2, s * p.conjugate()
        scale = 0.16 / (math.pi * (1 - 0.84 * math.cos(h) ** 2) ** 2) / 4
        block = [even, odd, 0, 0, odd, even, 0, 0, 0, 0, cross.real, cross.imag, 0, 0, -cross.imag, cross.real]
        return [scale * x for x in block]

    numbers = [x for _ in phi for d in theta_d for h in theta_h for index in indices.values() for x in matrix(index, d, h)]
    floats = lambda values: struct.pack(f"<{len(values)}f", *values)
    fields = [("phi_d", [1, len(phi)], 10, floats(phi)), ("theta_d", [1, len(theta_d)], 10, floats(theta_d)),
              ("theta_h", [1, len(theta_h)], 10, floats(theta_h)), ("wvls", [len(indices)], 3, struct.pack("<3H", *indices)),
              ("M", [len(phi), len(theta_d), len(theta_h), len(indices), 4, 4], 10, floats(numbers))]
    head = b"tensor_file\0\1\0" + struct.pack("<I", len(fields))
    place = len(head) + sum(2 + len(name) + 11 + 8 * len(shape) for name, shape, _, _ in fields)
    for name, shape, kind, data in fields:
        head += struct.pack("<H", len(name)) + name.encode() + struct.pack(f"<HBQ{len(shape)}Q", len(shape), kind, place, *shape)
        place += len(data)
    return head + b"".join(data for _, _, _, data in fields)


def washer():
    """A photometric file of a wall washer: a lobe at 38 degrees towards C0, and a narrow beam straight on."""
    def candela(c, gamma):
        lobe = 900 * math.exp(-(((gamma - 38) / 16) ** 2)) * max(0, 0.5 + 0.5 * math.cos(math.radians(c))) ** 3
        beam = 260 * math.exp(-((gamma / 14) ** 2))
        return (lobe + beam) * max(0, math.cos(math.radians(gamma))) ** 0.5 if gamma < 90 else 0

    gammas, planes = range(0, 91, 5), range(0, 181, 15)
    lines = ["IES:LM-63-2019", "[TEST] computed", "[TESTLAB] étendue", "[ISSUEDATE] 2026", "[MANUFAC] none",
             "[LUMINAIRE] wall washer, a formula", "TILT=NONE", f"1 -1 1 {len(gammas)} {len(planes)} 1 2 0 0 0", "1 1.00010 9"]
    lines += [" ".join(map(str, gammas)), " ".join(map(str, planes))]
    lines += [" ".join(f"{candela(c, gamma):.1f}" for gamma in gammas) for c in planes]
    return ("\n".join(lines) + "\n").encode()


def led():
    """A ray file of Zemax, in lumens: a square of 1 mm that shines along +z, narrower than Lambert's law."""
    def halton(i, base):
        x, part = 0.0, 1.0
        while i:
            part /= base
            x += part * (i % base)
            i //= base
        return x

    count, body = 1500, b""
    for i in range(1, count + 1):
        x, y, u, v = (halton(i, base) for base in (2, 3, 5, 7))
        z = (1 - u) ** 0.25  # cos³ of intensity
        side, turn = math.sqrt(1 - z * z), 2 * math.pi * v
        body += struct.pack("<7f", x - 0.5, y - 0.5, 0, side * math.cos(turn), side * math.sin(turn), z, 1 / count)
    head = struct.pack("<iI100s3f4fI9f4f4i", 1010, count, b"computed", 1, 1, 0.55, 0, 0, 0, 0, 4, *[0] * 6, 1, 1, 1, *[0] * 4, 0, 1, 0, 0)
    return head + body


FILES = {"sky.hdr": sky, "paint.json": paint, "gold.pbsdf": rough_gold, "washer.ies": washer, "led.dat": led}


def write_showcases(folder):
    folder.mkdir(parents=True, exist_ok=True)
    for make in SHOWCASES:
        scene = make()
        scene.write(folder / f"{scene.name}.gltf")
    for name, make in FILES.items():
        (folder / name).write_bytes(make())
