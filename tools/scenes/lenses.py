"""Lenses as optical elements: a camera behind one, a coupler, a spectrometer."""

from gltf_builder import Gltf, facing

MM = 1e-3
# Double Gauss f/2, US patent 2,673,491 (Tronnier): radius, thickness and index behind, diameter, in mm; the sixth is the stop.
DOUBLE_GAUSS = [
    (58.950, 7.520, 1.670, 50.4),
    (169.660, 0.240, 1.0, 50.4),
    (38.550, 8.050, 1.670, 46.0),
    (81.540, 6.550, 1.699, 46.0),
    (25.500, 11.410, 1.0, 36.0),
    (0, 9.000, 1.0, 34.2),
    (-28.990, 2.360, 1.603, 34.0),
    (81.540, 12.130, 1.658, 40.0),
    (-40.770, 0.380, 1.0, 40.0),
    (874.130, 6.440, 1.717, 40.0),
    (-79.460, 0, 1.0, 40.0),
]


def surfaces(rows, stop=None):
    """Rows of radius, thickness, index or glass, diameter, in mm."""
    result = []
    for i, (radius, thickness, glass, diameter) in enumerate(rows):
        row = {"radius": radius * MM, "thickness": thickness * MM, "semi_diameter": diameter / 2 * MM}
        if isinstance(glass, str):
            row["material"] = glass
        else:
            row["ior"] = glass
        if i == stop:
            row["stop"] = True
        result.append({key: round(value, 9) if isinstance(value, float) else value for key, value in row.items()})
    return result


def film(s, z, size, resolution, pupil):
    """At the height z on the axis of a lens through which light comes along +z, so that the picture is upright."""
    matrix = [-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, z, 1]
    s.receiver("film", matrix, "illuminance", size=size, resolution=resolution, pupil=pupil)


def double_gauss():
    s = Gltf(
        "double_gauss",
        "A camera with a real lens, the double Gauss of Tronnier's patent (100 mm, f/2; US 2,673,491), glass by glass: the film of 36 x 24 mm is an"
        " illuminance meter behind it. The middle ball, 2 m away, is sharp; small lamps in the background become disks that the lens's rims cut to"
        " cat's eyes toward the corners.",
    )
    s.element("lens", None, "lens_system", surfaces=surfaces(DOUBLE_GAUSS, stop=5))
    film(s, 64.08 * MM + 77.4251 * MM, [0.036, 0.024], [360, 240], [77.4251 * MM, 20.5 * MM])
    red = s.surface("red", "lambertian", reflectance=[0.6, 0.06, 0.05])
    grey = s.surface("grey", "lambertian", reflectance=[0.35, 0.35, 0.37])
    white = s.surface("white", "lambertian", reflectance=0.7)
    blue = s.surface("blue", "lambertian", reflectance=[0.06, 0.12, 0.5])
    s.quad("floor", grey, [[-3, -0.2, 0], [3, -0.2, 0], [3, -0.2, -8], [-3, -0.2, -8]])
    for name, material, place in (
        ("near ball", blue, [-0.12, -0.12, -1.3]),
        ("ball in focus", red, [0, -0.12, -2.08]),
        ("far ball", white, [0.25, -0.12, -3.2]),
    ):
        s.shape(name, "sphere", material, translation=place, radius=0.08)
    glow = s.emitter("lamps", 60000, color=(1, 0.8, 0.5))
    for i in range(-4, 5):
        for j in (-1, 0, 1):
            s.shape(f"lamp {i} {j}", "sphere", glow, translation=[0.24 * i + 0.12 * (j % 2), 0.22 + 0.24 * j, -6.0], radius=0.006)
    s.surround([300, 320, 360])
    return s


def ball_lens():
    s = Gltf(
        "ball_lens",
        "Light of a fibre of 50 µm (numerical aperture 0.12, 1 lm) is made parallel by a ball of glass (index 1.5168), 10 mm across, and brought into a second fibre by another one, 30 mm"
        " behind it, both uncoated (`ghosts`). `fibre` measures what that one takes, within 0.025 mm and the same aperture: the balls' spherical aberration and"
        " their four surfaces leave 0.688 of it; `end face` shows the spot.",
    )
    ball = [(5, 10, 1.5168, 9.9), (-5, 0, 1.0, 9.9)]
    focus = 2.337461  # mm from a ball
    s.element("first ball", None, "lens_system", surfaces=surfaces(ball), ghosts=True)
    second = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 40 * MM, 1]
    s.element("second ball", second, "lens_system", surfaces=surfaces(ball), ghosts=True)
    s.lamp("source", facing([0, 0, -focus * MM], [0, 0, -1]), "collimated", radius=0.025 * MM, divergence=0.12029, power=1)
    end = 50 * MM + focus * MM
    s.receiver("end face", facing([0, 0, end + 1e-6], [0, 0, -1]), "illuminance", size=[0.2 * MM, 0.2 * MM], resolution=[64, 64])
    s.receiver("fibre", facing([0, 0, end], [0, 0, -1]), "illuminance", size=[0.0443 * MM, 0.0443 * MM], resolution=[1, 1], pupil=[10 * MM, 1.20873 * MM])
    return s


# Radius, thickness, glass, diameter: an achromat of 100 mm, as it focuses parallel light, and the way back.
ACHROMAT = [(61.5, 8, "N-BK7", 30), (-44.6, 2.5, "N-SF5", 30), (-129.9, 0, 1.0, 30)]
COLLIMATOR = [(129.9, 2.5, "N-SF5", 30), (44.6, 8, "N-BK7", 30), (-61.5, 0, 1.0, 30)]
BACK_FOCUS = 95.07312  # mm


def spectrometer():
    s = Gltf(
        "spectrometer",
        "A grating spectrometer: light of a pinhole, made parallel by an achromat (focal length 100.28 mm), goes through a grating of 600 lines a mm, whose order 1 a second"
        " achromat focuses onto `sensor`, 24 mm long. The lamp has lines at 436, 546, 577 and 579 nm, as mercury has, 1 nm wide. They stand at"
        " 100.28 mm tan(asin(wavelength 600/mm) - 19.27°) from the middle: in columns 102, 250, 292 and 295 of 512; the last two, 0.13 mm apart, are parted.",
    )
    s.element("collimator", None, "lens_system", surfaces=surfaces(COLLIMATOR))
    ruled = s.surface("grating", "grating", period=1e-3 / 600, axis=-1.5707963268, orders=[{"order": 1, "transmitted": 1}], evanescent="absorbed")
    s.shape("grating", "rectangle", ruled, translation=[0, 0, 30 * MM], size=[0.03, 0.03])
    sine, cosine = 0.33, (1 - 0.33**2) ** 0.5  # of 550 nm

    def turned(distance, mirror=1):
        return [cosine, 0, -sine, 0, 0, mirror, 0, 0, mirror * sine, 0, mirror * cosine, 0, distance * MM * sine, 0, 30 * MM + distance * MM * cosine, 1]

    s.element("camera lens", turned(30), "lens_system", surfaces=surfaces(ACHROMAT))
    s.receiver("sensor", turned(40.5 + BACK_FOCUS, -1), "illuminance", size=[24 * MM, 2 * MM], resolution=[512, 8])
    nm, values = [], []
    for line in (436, 546, 577, 579):
        nm += [line - 1, line, line + 1]
        values += [0, 1, 0]
    nm[8:10], values[8:10] = [578], [0]
    lamp = {"wavelengths": nm, "values": values}
    s.lamp("pinhole", facing([0, 0, -BACK_FOCUS * MM], [0, 0, -1]), "collimated", radius=0.01 * MM, divergence=0.06, power=1, color=lamp)
    return s
