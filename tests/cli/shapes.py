"""Small meshes for the command line: a sphere, what can be wrong with it, and how to write them."""

import math

ICOSAHEDRON_FACES = [
    (0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
    (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1),
]


def unit(p):
    length = math.sqrt(sum(c * c for c in p))
    return tuple(c / length for c in p)


def sphere(subdivisions=2, radius=20.0, centre=(0, 0, 0)):
    """An icosahedron, its triangles split in four `subdivisions` times: 10 * 4**n + 2 vertices."""
    g = (1 + math.sqrt(5)) / 2
    vertices = [unit(p) for p in [
        (-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g), (g, 0, -1),
        (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]]
    faces = ICOSAHEDRON_FACES
    for _ in range(subdivisions):
        middle = {}

        def split(a, b):
            key = (min(a, b), max(a, b))
            if key not in middle:
                middle[key] = len(vertices)
                vertices.append(unit([(vertices[a][i] + vertices[b][i]) / 2 for i in range(3)]))
            return middle[key]

        finer = []
        for a, b, c in faces:
            ab, bc, ca = split(a, b), split(b, c), split(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        faces = finer
    return [tuple(radius * p[i] + centre[i] for i in range(3)) for p in vertices], faces


def ellipsoid(subdivisions=2, axes=(1.0, 0.8, 0.7)):
    vertices, faces = sphere(subdivisions)
    return [tuple(p[i] * axes[i] for i in range(3)) for p in vertices], faces


def off_text(mesh):
    vertices, faces = mesh
    lines = ["OFF", f"{len(vertices)} {len(faces)} 0"]
    lines += [" ".join(repr(float(c)) for c in p) for p in vertices]
    lines += [f"3 {a} {b} {c}" for a, b, c in faces]
    return "\n".join(lines) + "\n"


def obj_text(mesh):
    vertices, faces = mesh
    lines = ["v " + " ".join(repr(float(c)) for c in p) for p in vertices]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
    return "\n".join(lines) + "\n"


def stl_text(mesh):
    vertices, faces = mesh
    lines = ["solid mesh"]
    for face in faces:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += ["vertex " + " ".join(repr(float(c)) for c in vertices[v]) for v in face]
        lines += ["endloop", "endfacet"]
    return "\n".join(lines + ["endsolid mesh"]) + "\n"


def ply_text(mesh):
    vertices, faces = mesh
    lines = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}", "property double x", "property double y",
             "property double z", f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(repr(float(c)) for c in p) for p in vertices]
    lines += [f"3 {a} {b} {c}" for a, b, c in faces]
    return "\n".join(lines) + "\n"


def open_mesh():
    vertices, faces = sphere()
    return vertices, faces[1:]


def non_manifold_edge():
    """A third triangle on an edge, to a vertex of its own."""
    vertices, faces = sphere()
    a, b, _ = faces[0]
    return vertices + [(0.0, 0.0, 50.0)], faces + [(a, b, len(vertices))]


def inverted():
    vertices, faces = sphere()
    return vertices, [(a, c, b) for a, b, c in faces]


def one_flipped():
    vertices, faces = sphere()
    a, b, c = faces[7]
    return vertices, faces[:7] + [(a, c, b)] + faces[8:]


def self_intersecting():
    """One vertex pulled through the opposite side."""
    vertices, faces = sphere()
    x, y, z = vertices[0]
    return [(-1.5 * x, -1.5 * y, -1.5 * z)] + vertices[1:], faces


def not_finite():
    vertices, faces = sphere()
    return vertices[:5] + [(float("nan"), 1.0, 2.0)] + vertices[6:], faces


def two_spheres():
    vertices, faces = sphere()
    others, _ = sphere(centre=(100, 0, 0))
    shifted = [tuple(v + len(vertices) for v in face) for face in faces]
    return vertices + others, faces + shifted
