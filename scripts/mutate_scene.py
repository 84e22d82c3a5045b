#!/usr/bin/env python3
"""Makes malformed OBJ, PLY, STL and MGF files from sound ones: mutate_scene.py FOLDER [--count N] [--seed S].

Per format: named cases first, then tokens exchanged for hostile ones, then flipped bytes. The same seed gives the same
files. An OBJ comes with its material library, <name>.mtl, which is the mutated one of the two every third time.
"""
import random
import re
import struct
import sys


from mutation import SOUND_NAME, Case, flipped, library_of, main


# ---- Sound scenes: a lamp over a floor

OBJ = b"""mtllib LIBRARY
o floor
v 0 0 0
v 1 0 0 1 0.5 0.5
v 1 1 0
v 0 1 0
vt 0 0
vt 1 1
vn 0 0 1
usemtl wood
f 1/1/1 2/2/1 3/1/1 4/2/1
o lamp
v 0 0 1
v 1 0 1
v 1 1 1
usemtl light
s off
f -1 -2 -3
"""
MTL = b"""newmtl wood
Kd 0.5 0.4 0.3
map_Kd -s 2 2 1 -clamp on missing.png
d 0.9
newmtl light
Ka 0 0 0
Ke 5 5 5
illum 2
"""
PLY = b"""ply
format ascii 1.0
comment a lamp over a floor
element vertex 5
property float x
property float y
property float z
property uchar red
property uchar green
property uchar blue
element face 2
property list uchar int vertex_indices
end_header
0 0 0 255 0 0
1 0 0 255 255 0
1 1 0 255 255 255
0 1 0 0 0 255
0 0 1 9 9 9
4 0 1 2 3
3 4 2 1
"""
STL = b"""solid lamp
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 1 1 0
endloop
endfacet
facet normal 0 0 -1
outer loop
vertex 0 0 1
vertex 1 1 1
vertex 1 0 1
endloop
endfacet
endsolid lamp
"""
MGF = b"""# a lamp over a floor
m wood =
    c
        cxy 0.4 0.35
    rd 0.5
    sides 1
v a =
    p 0 0 0
    n 0 0 1
v b =
    p 1 0 0
v c =
    p 1 1 0
f a b c
m light =
    ed 100
o lamp
xf -t 0 0 1 -rx 180 -s 0.5 -a 3 -t 1 0 0
f a b c
sph a 0.25
cyl a 0.1 b
cone a 0.1 b 0
ring a 0.1 0.3
xf
o
"""


def binary_stl(triangles=2, announced=None):
    triangle = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0)
    return b"lamp".ljust(80, b"\0") + struct.pack("<I", triangles if announced is None else announced) + triangle * triangles


def binary_ply(order="little", vertices=4, faces=1, corners=4, announced=None):
    mark = "<" if order == "little" else ">"
    header = (f"ply\nformat binary_{order}_endian 1.0\nelement vertex {announced or vertices}\nproperty float x\n"
              f"property float y\nproperty float z\nelement face {faces}\nproperty list uchar int vertex_indices\nend_header\n")
    points = b"".join(struct.pack(mark + "3f", k in (1, 2), k in (2, 3), 0) for k in range(vertices))
    return header.encode() + points + (struct.pack("B", corners) + struct.pack(mark + "4i", 0, 1, 2, 3)) * faces


# ---- Named cases

def obj_cases():
    square = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
    for name, face in {"zero": b"f 0 1 2", "beyond": b"f 1 2 5", "before": b"f -5 -1 -2", "huge": b"f 1 2 99999999999999999999",
                       "two": b"f 1 2", "one": b"f 1", "none": b"f", "same": b"f 1 1 1", "slashes": b"f 1// 2// 3//",
                       "text": b"f a b c", "half": b"f 1.5 2 3", "int_min": b"f -2147483648 1 2", "texture": b"f 1/9 2/9 3/9"}.items():
        yield f"face_{name}", square + face + b"\n"
    for value in (b"nan", b"inf", b"-inf", b"1e39", b"1e999", b"-1e-999", b"0x10", b"1,5", b"--1", b"9" * 5000, b"", b"1e"):
        yield f"vertex_{value[:6].decode() or 'empty'}", square + b"v " + value + b" 0 0\nf 1 2 3\nf 1 2 5\n"
    yield "polygon_of_20000", square + b"f " + b"1 2 3 4 " * 5000 + b"\n"
    spiral = b"".join(b"v %d %d 0\n" % (k * (-1) ** k, k * (-1) ** (k // 2)) for k in range(3000))
    yield "polygon_crossing_itself", spiral + b"f " + b" ".join(b"%d" % k for k in range(1, 3001)) + b"\n"
    yield "line_of_1_mb", square + b"f 1 2 3\n# " + b"x" * 1_000_000 + b"\n"
    yield "continued_lines", square + b"f 1 2 \\\n" * 2000 + b"3\n"
    yield "names_50000", square + b"".join(b"o %d\ng %d\nusemtl %d\nf 1 2 3\n" % (k, k, k) for k in range(50_000))
    yield "utf16", (square + b"f 1 2 3\n").decode().encode("utf-16")
    yield "nul_bytes", square + b"f 1 2\0 3\nf 1 2 3\n"
    yield "carriage_returns", (square + b"f 1 2 3\n").replace(b"\n", b"\r")
    yield "library_is_itself", b"mtllib library_is_itself.obj\n" + square + b"f 1 2 3\n"
    for name, library in {"above": b"../../../etc/passwd", "absolute": b"/etc/passwd", "device": b"/dev/zero", "folder": b".",
                          "missing": b"missing.mtl", "long": b"x" * 9999, "none": b""}.items():
        yield f"library_{name}", b"mtllib " + library + b"\n" + square + b"f 1 2 3\n"


def mtl_cases():
    for name, line in {"nan": b"Kd nan nan nan", "huge": b"Ke 1e38 1e38 1e38", "double": b"Ke 1e300 0 0", "negative": b"Kd -1 -1 -1",
                       "short": b"Kd 0.5", "none": b"Kd", "text": b"Kd a b c", "map_none": b"map_Kd", "map_self": b"map_Kd .",
                       "map_above": b"map_Kd ../../../etc/passwd", "map_device": b"map_Kd /dev/zero", "spectral": b"Kd spectral x.rfl",
                       "map_options": b"map_Kd -s -o -t -mm 1", "before_name": b"\nnewmtl"}.items():
        yield f"library_{name}", OBJ, MTL + line + b"\n"
        yield f"library_first_{name}", OBJ, line + b"\n" + MTL


def ply_cases():
    yield "binary", binary_ply()
    yield "binary_big", binary_ply("big")
    yield "binary_cut", binary_ply()[:-5]
    yield "binary_4_g_vertices", binary_ply(announced=2**32 - 1)
    yield "binary_face_of_255", binary_ply(corners=255)
    yield "cut_header", PLY[:100]
    yield "binary_face_negative", binary_ply()[:-4] + b"\xff\xff\xff\xff"
    for name, (old, new) in {
            "4_g_faces": (b"face 2", b"face 4294967295"), "negative_count": (b"vertex 5", b"vertex -5"),
            "huge_count": (b"vertex 5", b"vertex 99999999999999999999"), "no_count": (b"vertex 5", b"vertex"),
            "list_of_floats": (b"list uchar int", b"list float float"), "list_of_lists": (b"property float x", b"property list uchar float x"),
            "type": (b"property float x", b"property complex x"), "double_name": (b"property float y", b"property float x"),
            "no_x": (b"property float x", b"property float w"), "format": (b"ascii", b"binary_middle_endian"),
            "version": (b"1.0", b"9.9"), "index": (b"4 0 1 2 3", b"4 0 1 2 9"), "negative_index": (b"4 0 1 2 3", b"4 0 1 2 -1"),
            "corners": (b"4 0 1 2 3", b"200 0 1 2 3"), "no_corners": (b"4 0 1 2 3", b"0"), "nan": (b"0 0 1 9", b"nan inf -inf 9"),
            "colour": (b"255 0 0", b"-1 256 1e9"), "no_faces": (b"face 2", b"face 0"), "no_end": (b"end_header", b""),
            "elements": (b"element face", b"element edge 3\nproperty list uint uchar x\nelement face")}.items():
        yield name, PLY.replace(old, new, 1)


def stl_cases():
    yield "binary", binary_stl()
    yield "binary_cut", binary_stl()[:-7]
    yield "binary_none", binary_stl(0)
    yield "binary_header", binary_stl()[:84]
    for count in (1, 3, 2**31, 2**32 - 1, 85899345):
        yield f"binary_announces_{count}", binary_stl(2, count)
    yield "binary_called_solid", b"solid" + binary_stl()[5:]
    yield "binary_nan", binary_stl()[:96] + struct.pack("<3f", float("nan"), float("inf"), 1e38) + binary_stl()[108:]
    for name, (old, new) in {"two_vertices": (b"vertex 1 0 0\n", b""), "nan": (b"vertex 1 0 0", b"vertex nan inf 1e999"),
                             "no_loop": (b"outer loop\n", b""), "no_end": (b"endsolid lamp\n", b""), "empty": (STL[11:-14], b""),
                             "text": (b"vertex 1 0 0", b"vertex a b c"), "normal": (b"0 0 1", b"nan nan nan")}.items():
        yield name, STL.replace(old, new, 1)


def mgf_cases():
    for name, line in {
            "array_billion": b"xf -a 1000000000 -t 1 0 0\nf a b c\nxf", "arrays_nested": b"xf -a 2000 -t 1 0 0 -a 2000 -t 0 1 0\nf a b c\nxf",
            "arrays_deep": b"xf -a 10 -t 1 0 0\n" * 12 + b"f a b c\n" + b"xf\n" * 12, "array_negative": b"xf -a -5 -t 1 0 0\nf a b c\nxf",
            "array_forever": b"xf -i 1000000000 -t 1 0 0\nf a b c\nxf", "scale_zero": b"xf -s 0\nf a b c\nxf", "scale_huge": b"xf -s 1e300\nf a b c\nxf",
            "context_deep": b"xf -t 0 0 1\n" * 100_000, "objects_deep": b"o x\n" * 100_000, "context_underflow": b"xf\nxf\nxf\no\no",
            "include_itself": b"i include_itself.mgf", "include_above": b"i ../../../etc/passwd", "include_device": b"i /dev/zero",
            "include_missing": b"i missing.mgf", "include_billion": b"i include_billion.mgf -a 1000 -t 1 0 0", "include_none": b"i",
            "vertex_unknown": b"f x y z", "vertex_nan": b"v n =\np nan inf 1e999\nf a b n", "face_two": b"f a b", "face_many": b"f " + b"a b c " * 5000,
            "sphere_nan": b"sph a nan", "sphere_huge": b"sph a 1e38", "torus": b"v n =\np 0 0 0\nn 0 0 1\ntorus n 0 1", "torus_inner": b"v n =\np 0 0 0\nn 0 0 1\ntorus n 3 1",
            "ring_inverted": b"v n =\np 0 0 0\nn 0 0 1\nring n 2 1", "cone_both_zero": b"cone a 0 b 0", "cylinder_same": b"cyl a 1 a",
            "prism_flat": b"prism a b c 0", "prism_nan": b"prism a b c nan", "material_nan": b"m n =\nrd nan\ned inf\nf a b c",
            "material_above_1": b"m n =\nrd 2\nrs 2\nf a b c", "colour_black": b"m n =\nc\ncxy 0 0\nrd 0.5\nf a b c", "spectrum": b"c s =\ncspec 400 700 nan -1 1e300\nm n =\nc s\nrd 1\nf a b c",
            "spectrum_reversed": b"c s =\ncspec 700 400 1 1\nm n =\nc s\nrd 1\nf a b c", "spectrum_empty": b"c s =\ncspec 0 0",
            "blackbody": b"c s =\ncct -5\nm n =\nc s\ned 1\nf a b c", "mix": b"c s =\ncmix 0 s 0 s", "unknown": b"frobnicate 1 2 3", "copy_itself": b"v q = q\nf q q q",
            "ies": b"ies missing.ies", "face_holes": b"fh a b c - a b c - a", "continued": b"f a b \\\n" * 3000 + b"c"}.items():
        yield name, MGF + line + b"\n"


# ---- Cases by chance

HOSTILE_TOKENS = (b"nan", b"inf", b"-1", b"0", b"1e39", b"1e-46", b"1e999", b"2147483648", b"4294967295", b"18446744073709551616", b"",
                  b"x", b"\xff\xfe", b"\0", b"-", b"/", b"\\", b"#", b"=", b"..", b"9" * 400)


def with_other_tokens(random_, content):
    """With some words exchanged for hostile ones or for other words, and lines dropped or repeated."""
    words = re.split(rb"([ \n]+)", content)
    for _ in range(random_.randint(1, 4)):
        at = random_.randrange(0, len(words), 2)
        kind = random_.randrange(4)
        if kind < 2:
            words[at] = random_.choice(HOSTILE_TOKENS)
        elif kind == 2:
            words[at] = random_.choice(words[::2])
        else:
            end = min(len(words), at + 2 * random_.randint(1, 6))
            words[at:end] = random_.choice(([b""], words[at:end] * 3))
        if not words:
            break
    return b"".join(words)


SOUND = {"obj": (OBJ,), "ply": (PLY, binary_ply(), binary_ply("big")), "stl": (STL, binary_stl()), "mgf": (MGF,)}
NAMED = {"obj": obj_cases, "ply": ply_cases, "stl": stl_cases, "mgf": mgf_cases}
FORMATS = tuple(SOUND)


def with_library(name, obj, mtl=MTL):
    return Case(name, obj.replace(b"LIBRARY", library_of(name).encode()), mtl)


def cases(kind, count, seed):
    """The sound scenes and `count` cases of a format, named ones first and at most half of them."""
    for number, content in enumerate(SOUND[kind]):
        name = f"{SOUND_NAME}_{number}.{kind}"
        yield with_library(name, content) if kind == "obj" else Case(name, content)
    random_ = random.Random(f"{kind} {seed}")
    named = [Case(f"{name}.{kind}", content) for name, content in NAMED[kind]()]
    if kind == "obj":
        named += [with_library(f"{name}.obj", obj, mtl) for name, obj, mtl in mtl_cases()]
    if len(named) > count // 2:
        named = random_.sample(named, count // 2)
    yield from named
    for number in range(count - len(named)):
        change = with_other_tokens if number % 2 == 0 else flipped
        name = f"{change.__name__}_{number}.{kind}"
        if kind == "obj" and number % 3 == 0:
            yield with_library(name, OBJ, change(random_, MTL))
        else:
            content = change(random_, random_.choice(SOUND[kind]))
            yield with_library(name, content) if kind == "obj" else Case(name, content)


def all_cases(count, seed):
    """`count` cases of every format."""
    for kind in FORMATS:
        yield from cases(kind, count, seed)


if __name__ == "__main__":
    sys.exit(main(__doc__, 150, all_cases))
