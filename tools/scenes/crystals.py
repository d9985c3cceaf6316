"""A rhomb of calcite on a printed page, which is seen twice through it."""

import math

from gltf_builder import Gltf, cross, unit

LETTERS = {  # five columns by seven rows
    "c": ".###. #...# #.... #.... #.... #...# .###.",
    "a": ".###. #...# #...# ##### #...# #...# #...#",
    "l": "#.... #.... #.... #.... #.... #.... #####",
    "i": ".###. ..#.. ..#.. ..#.. ..#.. ..#.. .###.",
    "t": "##### ..#.. ..#.. ..#.. ..#.. ..#.. ..#..",
    "e": "##### #.... #.... ####. #.... #.... #####",
}


def printed(scene, material, text, x, z, dot, height):
    """Squares of ink above the plane of the page, as seen from above with -z upward; (x, z): the middle of the line."""
    points, triangles = [], []
    left = x - dot * (6 * len(text) - 1) / 2
    for k, letter in enumerate(text):
        for row, cells in enumerate(LETTERS[letter].split()):
            for column, cell in enumerate(cells):
                if cell == "#":
                    n, u, v = len(points), left + dot * (6 * k + column), z + dot * (row - 3.5)
                    points += [[u, height, v], [u, height, v + dot], [u + dot, height, v + dot], [u + dot, height, v]]
                    triangles += [[n, n + 1, n + 2], [n, n + 2, n + 3]]
    scene.mesh(f"ink: {text}", material, points, triangles)


def rhomb(thickness, edge):
    """Edges and optic axis of a rhombohedron of calcite that lies on a face: three equal edges meet at a blunt corner under 101.92°
    each, and the axis makes equal angles with them. Its faces are `thickness` apart."""
    beta = math.acos(math.sqrt((1 + 2 * math.cos(math.radians(101.9167))) / 3))  # of an edge with the axis
    edges = [
        [math.sin(beta) * math.cos(p), math.sin(beta) * math.sin(p), math.cos(beta)]
        for p in (0, 2 * math.pi / 3, 4 * math.pi / 3)
    ]
    up = unit(cross(edges[0], edges[1]))
    if sum(u * e for u, e in zip(up, edges[2])) < 0:
        up = [-u for u in up]
    middle = unit([a + b for a, b in zip(edges[0], edges[1])])  # of the face's blunt corner: +z of the scene
    side = cross(up, middle)
    frame = (side, up, middle)

    def turned(v):
        return [sum(a * b for a, b in zip(f, v)) for f in frame]

    lengths = (edge, edge, thickness / sum(u * e for u, e in zip(up, edges[2])))
    return [[length * c for c in turned(e)] for length, e in zip(lengths, edges)], turned([0, 0, 1])


def calcite():
    s = Gltf(
        "calcite",
        "A cleavage rhomb of calcite, 10 mm thick, on a printed page under a white sky of 100 cd/m²: all that is printed is seen twice"
        " through it. Its axis is at 44.6° to the faces; the second camera, which looks straight down and measures Stokes vectors,"
        " sees the extraordinary image 1.09 mm beside the ordinary one, along the short diagonal of the upper face (S1 and S2 of the"
        " edges have opposite signs). Both are of half the light; the ordinary one stays where it is seen without the crystal.",
    )
    paper = s.surface("paper", "lambertian", reflectance=0.8)
    s.shape("page", "rectangle", paper, matrix=_flat(), size=[0.08, 0.06])
    ink = s.surface("ink", "lambertian", reflectance=0.02)
    for row in range(5):
        printed(s, ink, "calcite", 0, 0.008 * (row - 2), 0.0007, 1e-5)
    edges, axis = rhomb(0.010, 0.020)
    s.medium("calcite", **{"class": "uniaxial", "ior_ordinary": 1.6584, "ior_extraordinary": 1.4864, "axis": axis})
    base = [-sum(e[i] for e in edges) / 2 for i in range(3)]
    base[1] = 5e-5  # it rests on a film of air
    corners = [
        [base[i] + sum(edges[k][i] for k in range(3) if bits >> k & 1) for i in range(3)] for bits in range(8)
    ]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    middle = [sum(c[i] for c in corners) / 8 for i in range(3)]
    triangles = []
    for f in faces:
        a, b, c = (corners[i] for i in f[:3])
        normal = cross([q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)])
        if sum(n * (p - m) for n, p, m in zip(normal, a, middle)) < 0:
            f = f[::-1]
        triangles += [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]
    s.mesh("calcite", s.surface("calcite", "dielectric", inside="calcite"), corners, triangles)
    s.surround(100)
    s.camera([0.02, 0.085, 0.06], [0, 0.002, 0.001], 24, 1.5, "camera")
    s.orthographic([0, 0.1, 1e-4], [0, 0, 0], 0.016, 1.5, "above", stokes=True)
    return s


def _flat():
    """x stays, and z of the shape is up."""
    return [1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1]
