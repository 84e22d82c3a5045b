#!/usr/bin/env python3
"""Writes a variant of an OBJ scene, with its MTL beside it, to try a program on a scene it has not seen.

    vary_scene.py IN.obj OUT.obj [--move MATERIAL=dx,dy,dz]... [--subdivide MATERIAL=SEED]...
                  [--permute-albedos SEED] [--rotate=AXIS_X,AXIS_Y,AXIS_Z,DEGREES]

In this order, lengths in the file's units:
  --move             moves all polygons of a material; may be repeated
  --subdivide        cuts the polygons of a material at random places until there are at least 12 convex pieces of
                     three or four corners, which tile them exactly; their corners may lie on neighbours' edges
  --permute-albedos  exchanges the reflectances (Kd) of the materials that are used and do not emit
  --rotate           turns everything about the centre of the bounding box

Normals and texture coordinates are not carried over, and neither are textures.
"""
import argparse
import math
import random
import sys
from pathlib import Path

PIECES = 12


class InputError(Exception):
    pass


# ---- Reading and writing. A polygon is a pair (material, corners).

def read_obj(path):
    """The polygons, and the paths of the material libraries."""
    vertices, polygons, libraries, dropped = [], [], [], set()
    material = None
    for line_number, line in enumerate(read_lines(path), 1):
        key, *values = line.split("#")[0].split() or [""]
        try:
            if key == "v":
                vertices.append(tuple(float(x) for x in values[:3]))
                if len(vertices[-1]) < 3 or not all(map(math.isfinite, vertices[-1])):
                    raise ValueError("three finite coordinates expected")
            elif key == "f":
                indices = [int(value.split("/")[0]) for value in values]
                indices = [i - 1 if i > 0 else len(vertices) + i for i in indices]
                if len(indices) < 3 or not all(0 <= i < len(vertices) for i in indices):
                    raise ValueError("three or more indices of vertices above this line expected")
                polygons.append((material, [vertices[i] for i in indices]))
            elif key == "usemtl":
                material = line.split(None, 1)[1].strip()
            elif key == "mtllib":
                libraries.append(path.parent / line.split(None, 1)[1].strip())
            elif key in ("vn", "vt"):
                dropped.add(key)
        except (ValueError, IndexError) as error:
            raise InputError(f"{path}:{line_number}: '{line.strip()}': {error}") from None
    if not polygons:
        raise InputError(f"{path}: there are no polygons in it")
    if dropped:
        print(f"{path}: {' and '.join(sorted(dropped))} lines are not carried over", file=sys.stderr)
    return polygons, libraries


def read_lines(path):
    try:
        return path.read_text(encoding="utf-8", errors="surrogateescape").splitlines()
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from None


def read_mtl(paths):
    """name -> the lines of the material, without textures."""
    materials, lines = {}, []
    for path in paths:
        for line in read_lines(path):
            key, *values = line.split() or [""]
            if key == "newmtl":
                lines = materials.setdefault(line.split(None, 1)[1].strip(), [])
            elif key and not key.startswith(("#", "map_", "bump", "disp", "decal", "refl", "norm")):
                lines.append(line.strip())
    return materials


def colour(lines, key):
    """A material's Kd or Ke; a single number stands for all three channels."""
    for line in lines:
        name, *values = line.split()
        if name == key:
            numbers = tuple(float(x) for x in values[:3])
            return numbers if len(numbers) == 3 else numbers[:1] * 3
    return (0.0, 0.0, 0.0)


def write_scene(path, polygons, materials):
    index, lines, current = {}, [], None
    for material, points in polygons:
        if material != current and material is not None:
            lines.append(f"usemtl {material}")
            current = material
        lines.append("f " + " ".join(str(index.setdefault(p, len(index) + 1)) for p in points))
    library = path.with_suffix(".mtl")
    lines = [f"mtllib {library.name}"] + ["v " + " ".join(map(repr, p)) for p in index] + lines
    write_lines(path, lines)
    write_lines(library, [text for name, entries in materials.items() for text in (f"newmtl {name}", *entries)])


def write_lines(path, lines):
    try:
        path.write_text("\n".join(lines) + "\n", encoding="utf-8", errors="surrogateescape")
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from None


# ---- Geometry

def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def area_vector(points):
    fan = [cross(sub(a, points[0]), sub(b, points[0])) for a, b in zip(points[1:], points[2:])]
    return tuple(sum(axis) / 2 for axis in zip(*fan))


def area(points):
    return math.hypot(*area_vector(points))


def move(polygons, name, offset):
    """Moves the polygons of material `name`."""
    return [(material, [tuple(map(sum, zip(p, offset))) for p in points] if material == name else points)
            for material, points in polygons]


def rotation(polygons, axis, degrees):
    """The function that turns a point about the bounding box's centre (Rodrigues' formula), and a direction likewise."""
    size = math.hypot(*axis)
    if size == 0:
        raise InputError("--rotate: the axis has no length")
    axis = tuple(x / size for x in axis)
    corners = [p for _, points in polygons for p in points]
    middle = tuple((min(values) + max(values)) / 2 for values in zip(*corners))
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))

    def turned_direction(v):
        along, across = dot(axis, v), cross(axis, v)
        return tuple(c * x + s * y + (1 - c) * along * a for x, y, a in zip(v, across, axis))

    def turned(p):
        return tuple(m + x for m, x in zip(middle, turned_direction(sub(p, middle))))
    return turned, turned_direction


def rotate(polygons, axis, degrees):
    """Turns about the bounding box's centre."""
    turned, _ = rotation(polygons, axis, degrees)
    return [(material, [turned(p) for p in points]) for material, points in polygons]


def is_planar(points):
    normal = area_vector(points)
    size = max(math.hypot(*sub(p, points[0])) for p in points)
    return all(abs(dot(sub(p, points[0]), normal)) <= 1e-9 * size * math.hypot(*normal) for p in points)


def cut(points, rng):
    """Cuts a convex triangle or quad into two pieces, none with more than four corners."""
    first = rng.randrange(len(points))
    points = points[first:] + points[:first]

    def between(a, b):
        t = rng.uniform(.25, .75)
        return tuple(x + t * (y - x) for x, y in zip(a, b))
    on_first = between(points[0], points[1])
    if len(points) == 3:
        if rng.random() < .5:  # from a corner to the edge opposite
            return [points[0], on_first, points[2]], [on_first, points[1], points[2]]
        other = between(points[1], points[2])
        return [on_first, points[1], other], [points[0], on_first, other, points[2]]
    if rng.random() < .3:  # from a corner to an edge that does not end there
        return [on_first, points[1], points[2]], [points[0], on_first, points[2], points[3]]
    other = between(points[2], points[3])
    return [on_first, points[1], points[2], other], [points[0], on_first, other, points[3]]


def subdivide(polygons, name, seed):
    """Cuts the polygons of material `name`, always the largest piece, into at least PIECES."""
    rng = random.Random(seed)
    pieces = []
    for points in (points for material, points in polygons if material == name):
        if len(points) > 4 or not is_planar(points):  # to be tiled exactly, a surface must be known exactly
            pieces += [[points[0], a, b] for a, b in zip(points[1:], points[2:])]
        else:
            pieces.append(points)
    while len(pieces) < PIECES:
        largest = max(range(len(pieces)), key=lambda k: area(pieces[k]))
        pieces += cut(pieces.pop(largest), rng)
    return [polygon for polygon in polygons if polygon[0] != name] + [(name, points) for points in pieces]


def permute_albedos(materials, used, seed):
    """Exchanges the Kd of the used materials that do not emit, such that some colour changes if any can."""
    names = [name for name in materials if name in used and not any(colour(materials[name], "Ke"))]
    before = [colour(materials[name], "Kd") for name in names]
    after = before[:]
    rng = random.Random(seed)
    if len(set(before)) > 1:
        while after == before:
            rng.shuffle(after)
    changed = dict(materials)
    for name, kd in zip(names, after):
        rest = [line for line in materials[name] if line.split()[0] != "Kd"]
        changed[name] = ["Kd " + " ".join(map(repr, kd)), *rest]
    return changed


# ---- The program

def numbers(text, count, option):
    try:
        values = tuple(float(x) for x in text.split(","))
    except ValueError:
        values = ()
    if len(values) != count or not all(map(math.isfinite, values)):
        raise InputError(f"{option}: {count} numbers separated by commas expected, found '{text}'")
    return values


def for_material(text, polygons, option):
    """MATERIAL=VALUE, and the material must occur."""
    name, _, value = text.rpartition("=")
    known = list(dict.fromkeys(str(material) for material, _ in polygons))
    if name not in known:
        raise InputError(f"{option} {text}: MATERIAL=VALUE expected, with one of the materials {', '.join(known)}")
    return name, value


def run(arguments):
    polygons, libraries = read_obj(arguments.input)
    materials = read_mtl(libraries)
    for text in arguments.move:
        name, value = for_material(text, polygons, "--move")
        polygons = move(polygons, name, numbers(value, 3, "--move"))
    for text in arguments.subdivide:
        name, seed = for_material(text, polygons, "--subdivide")
        polygons = subdivide(polygons, name, seed)
    if arguments.permute_albedos is not None:
        materials = permute_albedos(materials, {material for material, _ in polygons}, arguments.permute_albedos)
    if arguments.rotate is not None:
        *axis, degrees = numbers(arguments.rotate, 4, "--rotate")
        polygons = rotate(polygons, axis, degrees)
    if arguments.output.resolve() == arguments.input.resolve():
        raise InputError(f"{arguments.output}: would overwrite its input")
    write_scene(arguments.output, polygons, materials)


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("input", type=Path, metavar="IN.obj")
    parser.add_argument("output", type=Path, metavar="OUT.obj")
    parser.add_argument("--move", action="append", default=[], metavar="MATERIAL=dx,dy,dz")
    parser.add_argument("--subdivide", action="append", default=[], metavar="MATERIAL=SEED")
    parser.add_argument("--permute-albedos", type=int, metavar="SEED")
    parser.add_argument("--rotate", metavar="AXIS_X,AXIS_Y,AXIS_Z,DEGREES",
                        help="written --rotate=... where it begins with a minus sign")
    try:
        run(parser.parse_args(argv))
    except InputError as error:
        print(f"vary_scene: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
