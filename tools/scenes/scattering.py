"""Media that scatter light."""

import math

from gltf_builder import Gltf, look_along
from shared import hanging_lamp, walls


def glass_in_fog():
    s = Gltf(
        "glass_in_fog",
        "A glass sphere (index 1.5, radius 0.35 m) hangs in a cube of fog, which scatters a quarter of the light on each metre,"
        " under a lamp of 0.07 x 0.07 m whose light it gathers: a bright cone in the fog narrows towards a spot on the floor, and"
        " the shadow around it is a dark cone. The lamp sends pi x 1500 x 0.956 x 0.0049 m² = 22.1 lm; 0.956 is the luminance of"
        " its colour.",
    )
    s.medium("fog", scattering=0.25, phase={"class": "henyey_greenstein", "g": 0.4})
    s.medium("glass", ior=1.5)
    grey = s.surface("grey", "lambertian", reflectance=0.3)
    border = s.surface("border of the fog", "boundary", inside="fog")
    glass = s.surface("glass", "dielectric", inside="glass", outside="fog")
    lamp = s.emitter("lamp", 1500, (1, 0.95, 0.88))
    walls(s, (-3, 0, -3), (3, 0, 3), floor=grey)
    s.box("fog", border, [2.6, 2.6, 2.6], translation=[0, 0.02, 0])
    hanging_lamp(s, lamp, (0, 2.4, 0), 0.07, 0.07)
    s.shape("glass sphere", "sphere", glass, [0, 1.5, 0], radius=0.35)
    s.camera([0, 1.9, 6.5], [0, 1.2, 0], 26, 1)
    return s


def noise(x, y, z):
    """Smooth random numbers between -1 and 1: a hash at the points of a lattice of unit width, cubic between them."""

    def corner(i, j, k):
        h = (i * 0x8DA6B343 + j * 0xD8163841 + k * 0xCB1AB31F) & 0xFFFFFFFF
        h = (h ^ h >> 15) * 0x2C1B3C6D & 0xFFFFFFFF
        return ((h ^ h >> 13) & 0xFFFF) / 32767.5 - 1

    def between(a, b, t):
        return a + (b - a) * t * t * (3 - 2 * t)

    i, j, k = math.floor(x), math.floor(y), math.floor(z)
    planes = []
    for c in (k, k + 1):
        rows = [between(corner(i, b, c), corner(i + 1, b, c), x - i) for b in (j, j + 1)]
        planes.append(between(rows[0], rows[1], y - j))
    return between(planes[0], planes[1], z - k)


def cumulus():
    """A heap of balls over a flat base, frayed by noise: bytes of a lattice of 4 m, as NRRD."""
    nx, ny, nz, step = 68, 44, 52, 4.0
    low = (-nx * step / 2, 0.0, -nz * step / 2)
    balls = [(-68, 38, 5, 56), (0, 55, -15, 80), (66, 40, 10, 58), (18, 105, -8, 58), (-25, 68, 32, 62), (38, 40, 40, 56)]
    data = bytearray()
    for k in range(nz):
        for j in range(ny):
            for i in range(nx):
                x, y, z = low[0] + i * step, low[1] + j * step, low[2] + k * step
                inside = max(1 - math.dist((x, y, z), ball[:3]) / ball[3] for ball in balls)
                if inside > -0.6 and y > 0:
                    for octave in range(4):
                        f = 0.021 * 2.1**octave
                        inside += 0.26 * 0.6**octave * noise(f * x, f * y + 7 * octave, f * z)
                inside *= min(1.0, y / 20)
                edge = i in (0, nx - 1) or j in (0, ny - 1) or k in (0, nz - 1)
                data.append(0 if edge or inside <= 0 else min(255, round(255 * min(1, 4 * inside))))
    header = (
        f"NRRD0004\ntype: uchar\ndimension: 3\nsizes: {nx} {ny} {nz}\nencoding: raw\nspace dimension: 3\n"
        f"space directions: ({step},0,0) (0,{step},0) (0,0,{step})\n"
        f"space origin: ({low[0]},{low[1]},{low[2]})\n\n"
    )
    return header.encode() + bytes(data)


def cloud():
    s = Gltf(
        "cloud",
        "A small cumulus, 250 m wide, from the file cloud.nrrd: droplets that scatter, mostly forward, and absorb nothing, 0.08/m"
        " where they are densest. The sun stands high on the left: that side is bright, almost white, every fold of it"
        " shades the next; the flat base is grey, with a little green of the plain, and the shadow below has soft edges. Where the"
        " cloud is thin, at its fringes, the sky shines through.",
    )
    s.surround([0.23, 0.38, 0.72])
    s.files["cloud.nrrd"] = cumulus()
    s.medium(
        "cloud",
        **{"class": "grid"},
        file={"name": "cloud.nrrd", "translation": [0, 60, 0]},
        density=1 / 255,
        scattering=0.08,
        phase={"class": "henyey_greenstein", "g": 0.6},
    )
    border = s.surface("border of the cloud", "boundary", inside="cloud")
    plain = s.surface("plain", "lambertian", reflectance=[0.16, 0.2, 0.08])
    s.quad("plain", plain, [[-3000, 0, 3000], [3000, 0, 3000], [3000, 0, -3000], [-3000, 0, -3000]])
    s.box("cloud", border, [270, 174, 206], translation=[-2, 146.5, -2])
    s.light("sun", "directional", 7, look_along([0, 0, 0], [0.66, -0.7, -0.27]), (1, 0.94, 0.85))
    s.camera([60, 40, 520], [0, 122, 0], 30, 1.5)
    return s


def fogbow():
    s = Gltf(
        "fogbow",
        "A bank of fog, 50 to 170 m away, that a low sun behind the viewer shines into: droplets of water of 10 µm (effective"
        " radius; variance 0.03) before dark ground and a dim sky. Around the point opposite the sun, the middle of the image, stands"
        " a broad white bow, brightest at 38 degrees, red outside and blue inside, 1.8 times as bright as the fog 33 degrees from the"
        " middle, with a fainter bow within it, at 30 degrees. In the middle is the glory, three times as bright as the fog around,"
        " with a red ring at 2 degrees. The camera measures Stokes vectors: two thirds of the bow's light, a quarter of the fainter"
        " one's, swing along the bow, a quarter of the glory's ring across it.",
    )
    s.surround([0.012, 0.02, 0.035])
    s.medium(
        "fog",
        scattering=0.001,
        phase={"class": "mie", "radius": 1e-5, "variance": 0.03, "ior": {"name": "water ior"}},
    )
    border = s.surface("border of the fog", "boundary", inside="fog")
    ground = s.surface("ground", "lambertian", reflectance=[0.006, 0.006, 0.005])
    s.quad("ground", ground, [[-450, 0, 60], [450, 0, 60], [450, 0, -500], [-450, 0, -500]])
    s.box("fog", border, [600, 260, 120], translation=[0, 0.5, -110])
    down = [0, -math.sin(math.radians(20)), -math.cos(math.radians(20))]
    s.light("sun", "directional", 50, look_along([0, 0, 0], down), (1, 0.97, 0.92))
    s.camera([0, 80, 0], [0, 80 + down[1], down[2]], 92, 1, stokes=True)
    return s
