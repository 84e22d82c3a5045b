#!/usr/bin/env python3
"""Writes the scenes of this folder: data/generate.py [FOLDER] (default: the folder of this file).

Running it again gives the same bytes. (classic_room.mgf and what it includes are written by hand: they show what only MGF
can say.) Python's standard library only. Lengths are metres, y is up where there is an up.
Faces are counter-clockwise seen from their front, which is the side that reflects and emits:
rooms face inwards, objects face outwards and are closed.
"""
import itertools
import math
import sys
from pathlib import Path

from polygon_files import write_ply, write_stl
from scene_files import (Camera, Image, Light, Mapping, Material, Node, Scene, rounded, write_gltf, write_mgf,
                         write_obj)

WRITERS = {"gltf": write_gltf, "obj": write_obj, "ply": write_ply, "stl": write_stl, "mgf": write_mgf}

# ---- Shapes

INSIDE_OF_BOX = {  # corners of each side as bits x y z, counter-clockwise seen from inside
    "x0": ("000", "010", "011", "001"), "x1": ("100", "101", "111", "110"),
    "y0": ("000", "001", "101", "100"), "y1": ("010", "110", "111", "011"),
    "z0": ("000", "100", "110", "010"), "z1": ("001", "011", "111", "101"),
}


def box(low, high, material, inward=False):
    """Six quads in the order x0 x1 y0 y1 z0 z1. `material` is one name for all sides, or a function of the side."""
    faces = []
    for side, corners in INSIDE_OF_BOX.items():
        points = [tuple((low, high)[int(bit)][axis] for axis, bit in enumerate(corner)) for corner in corners]
        name = material(side) if callable(material) else material
        faces.append((name, points if inward else points[::-1]))
    return faces


def lathe(profile, sides, material):
    """Solid of revolution about y. `profile`: (radius, y) from the bottom to the top, beginning and ending on the axis;
    `material(k)` is that of the band between the profile's points k and k+1."""
    def point(k, i):
        radius, y = profile[k]
        angle = 2 * math.pi * (i % sides) / sides
        return (rounded(radius * math.cos(angle)), y, rounded(radius * math.sin(angle)))
    faces = []
    for k in range(len(profile) - 1):
        for i in range(sides):
            quad = [point(k, i), point(k + 1, i), point(k + 1, i + 1), point(k, i + 1)]
            faces.append((material(k), [p for j, p in enumerate(quad) if p not in quad[:j]]))
    return faces


# ---- The Cornell box

def cornell_box():
    """Corners in millimetres, as published. The left wall is not quite planar, the blocks have no bottom."""
    quads = {
        "floor": [[(552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2)]],
        "ceiling": [  # around the light
            [(556, 548.8, 0), (556, 548.8, 227), (0, 548.8, 227), (0, 548.8, 0)],
            [(556, 548.8, 332), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 332)],
            [(556, 548.8, 227), (556, 548.8, 332), (343, 548.8, 332), (343, 548.8, 227)],
            [(213, 548.8, 227), (213, 548.8, 332), (0, 548.8, 332), (0, 548.8, 227)]],
        "light": [[(343, 548.8, 227), (343, 548.8, 332), (213, 548.8, 332), (213, 548.8, 227)]],
        "back": [[(549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2)]],
        "right": [[(0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2)]],
        "left": [[(552.8, 0, 0), (549.6, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0)]],
        "short": standing_block(165, [(130, 65), (82, 225), (240, 272), (290, 114)]),
        "tall": standing_block(330, [(423, 247), (265, 296), (314, 456), (472, 406)]),
    }
    meshes = {name: [[(name, [tuple(x / 1000 for x in p) for p in quad]) for quad in faces]]
              for name, faces in quads.items()}
    white, green, red = Material((.725, .71, .68)), Material((.14, .45, .091)), Material((.63, .065, .05))
    materials = {name: white for name in quads}
    materials |= {"light": Material((.78, .78, .78), (17, 12, 4)), "right": green, "left": red}
    return Scene(
        "cornell_box",
        ["The Cornell box in metres. Measurements: Cornell University Program of Computer Graphics, Cornell box data.",
         "One material per surface: floor, ceiling, light, back, right (green), left (red), short, tall (the blocks)."],
        materials, meshes, [Node(name, name) for name in meshes],
        # Published: focal length 35 mm behind a film of 25 x 25 mm.
        Camera((.278, .273, -.8), (.278, .273, 0), 2 * math.atan(.0125 / .035), 1))


def standing_block(height, top):
    """Top and four sides; `top` runs counter-clockwise seen from above."""
    faces = [[(x, height, z) for x, z in top]]
    for (x0, z0), (x1, z1) in zip(top, top[1:] + top[:1]):
        faces.append([(x0, 0, z0), (x1, 0, z1), (x1, height, z1), (x0, height, z0)])
    return faces


# ---- Cases with exact answers

def grey(reflectance, emitted_radiosity=0.0):
    return Material((reflectance,) * 3, (emitted_radiosity / math.pi,) * 3)


def room_case(name, size, reflectances, emitted, comment):
    materials = {side: grey(*values) for side, values in zip(INSIDE_OF_BOX, zip(reflectances, emitted))}
    meshes = {side: [[face]] for side, face in
              zip(INSIDE_OF_BOX, box((0, 0, 0), size, lambda side: side, inward=True))}
    return Scene(name, [*comment, "Seen from inside; x0 is the face at the least x, and so on."],
                 materials, meshes, [Node(side, side) for side in meshes])


def facing_squares(name, squares, comment):
    names = "ab"
    meshes = {n: [[(n, square)]] for n, square in zip(names, squares)}
    return Scene(name, comment + ["Reflectance 0.5; a emits the radiosity 1, b nothing."],
                 {"a": grey(.5, 1), "b": grey(.5)}, meshes, [Node(n, n) for n in names])


def analytic_cases():
    cases = [room_case("cube6", (1, 1, 1), (.65, .15, .5, .8, .7, .3), (0, 0, 0, 1, 0, .25),
                       ["Unit cube; emitted radiosity 1 at y1, 0.25 at z1. Answers: reference/analytic.json, cube6."]),
             room_case("room432", (4, 3, 2.5), (.5, .5, .5, .5, .2, .8), (0, 0, 0, 0, 0, 100),
                       ["Room of 4 x 3 x 2.5 m whose ceiling z1 emits the radiosity 100; z0 is the floor.",
                        "Answers: reference/analytic.json, room432."])]
    corners = [(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]
    faces = [(1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)]  # face k is opposite corner k
    meshes = {f"f{k}": [[(f"f{k}", [corners[i] for i in face])]] for k, face in enumerate(faces)}
    materials = dict(zip(meshes, (grey(.2, 1), grey(.4), grey(.6), grey(.8))))
    cases.append(Scene("tetrahedron",
                       ["Regular tetrahedron seen from inside: every form factor between two faces is 1/3.",
                        "f0 emits the radiosity 1. Answers: reference/analytic.json, tetrahedron."],
                       materials, meshes, [Node(name, name) for name in meshes]))
    bottom = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    cases.append(facing_squares("parallel_squares", [bottom, [(0, 0, 1), (0, 1, 1), (1, 1, 1), (1, 0, 1)]],
                                ["Two unit squares facing each other at distance 1: F = 0.1998248957."]))
    cases.append(facing_squares("perpendicular_squares", [bottom, [(0, 0, 0), (0, 1, 0), (0, 1, 1), (0, 0, 1)]],
                                ["Two unit squares at a right angle with a common edge: F = 0.2000437761."]))
    return cases


def furnace_box():
    return Scene("furnace_box",
                 ["Closed box of 2 x 1.5 x 1 m seen from inside; all of it reflects 0.5 and emits the radiosity 1.",
                  "Everywhere, exactly: radiosity B = 1/(1 - 0.5) = 2, irradiance 2, radiance 2/pi."],
                 {"wall": grey(.5, 1)}, {"box": [box((0, 0, 0), (2, 1.5, 1), "wall", inward=True)]},
                 [Node("box", "box")])


# ---- A furnished room

WIDTH, HEIGHT, DEPTH = 5.2, 2.7, 4.1


def room_faces():
    """The room, seen from inside, with a window niche in its wall at z = 0."""
    names = {"x0": "wall_left", "x1": "wall_right", "y0": "floor", "y1": "ceiling", "z1": "wall_front"}
    faces = [face for face in box((0, 0, 0), (WIDTH, HEIGHT, DEPTH), lambda side: names.get(side, ""), inward=True)
             if face[0]]
    left, right, sill, top, back = 1.6, 3.2, .9, 2.1, -.25

    def upright(x0, x1, y0, y1, z, material):
        return (material, [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)])
    faces += [upright(0, left, 0, HEIGHT, 0, "wall_back"), upright(right, WIDTH, 0, HEIGHT, 0, "wall_back"),
              upright(left, right, 0, sill, 0, "wall_back"), upright(left, right, top, HEIGHT, 0, "wall_back")]
    niche = {"x0": "niche", "x1": "niche", "y0": "niche", "y1": "niche", "z0": "pane"}
    faces += [face for face in box((left, sill, back), (right, top, 0), lambda side: niche.get(side, ""), inward=True)
              if face[0]]
    return faces


def legs(half_x, half_z, thickness, height, material):
    return [box((x - (thickness if x > 0 else 0), 0, z - (thickness if z > 0 else 0)),
                (x + (thickness if x < 0 else 0), height, z + (thickness if z < 0 else 0)), material)
            for x in (-half_x, half_x) for z in (-half_z, half_z)]


def shelf_parts():
    """Stands at the wall x = 0."""
    parts = [box((0, 0, 0), (.3, 1.8, .02), "shelf"), box((0, 0, .98), (.3, 1.8, 1), "shelf"),
             box((0, 0, .02), (.01, 1.8, .98), "shelf")]
    return parts + [box((.01, y, .02), (.3, y + .02, .98), "shelf") for y in (0, .58, 1.16, 1.78)]


def sphere(radius, sides, bands, material):
    """Stands on y = 0."""
    angles = [math.pi * k / bands for k in range(bands + 1)]
    profile = [(rounded(radius * math.sin(a)), rounded(radius - radius * math.cos(a))) for a in angles]
    return lathe(profile, sides, lambda k: material)


def lamp_parts(cord, lamp, light):
    """Hangs from y = 0 on a cord; `lamp` is "plate" or "shade". Its underside is the light."""
    parts = [box((-.01, -cord, -.01), (.01, 0, .01), "metal")]
    if lamp == "plate":
        parts.append(box((-.16, -cord - .03, -.12), (.16, -cord, .12), lambda side: light if side == "y0" else "metal"))
    else:
        profile = [(0, -cord - .16), (.15, -cord - .16), (.05, -cord), (0, -cord)]
        parts.append(lathe(profile, 8, lambda k: (light, "lampshade", "lampshade")[k]))
    return parts


def table_room():
    warm, cool = (12, 8, 4), (6, 8, 11)
    materials = {
        "floor": Material((.42, .29, .18)), "ceiling": Material((.82, .81, .78)), "wall_left": Material((.66, .3, .2)),
        "wall_right": Material((.24, .42, .5)), "wall_back": Material((.72, .66, .54)),
        "wall_front": Material((.7, .7, .68)), "niche": Material((.8, .8, .8)), "pane": Material((.06, .08, .12)),
        "table": Material((.5, .33, .17)), "chair": Material((.2, .34, .24)), "shelf": Material((.62, .5, .34)),
        "book_red": Material((.55, .1, .09)), "book_blue": Material((.1, .17, .45)), "chest": Material((.58, .45, .12)),
        "column": Material((.74, .73, .7)), "ball": Material((.68, .2, .34)), "metal": Material((.35, .35, .36)),
        "lampshade": Material((.75, .7, .58)),
        "light_1": Material((.7, .7, .7), warm), "light_2": Material((.7, .7, .7), cool),
        "light_3": Material((.7, .7, .7), cool), "light_4": Material((.7, .7, .7), warm)}
    meshes = {
        "room": [room_faces()],
        "table": [box((-.8, .71, -.45), (.8, .75, .45), "table"), *legs(.76, .41, .06, .71, "table")],
        "chair": [box((-.21, .43, -.21), (.21, .47, .21), "chair"), *legs(.21, .21, .04, .43, "chair"),
                  box((-.21, .47, .18), (.21, .89, .21), "chair")],
        "shelf": shelf_parts(),
        "book_red": [box((-.09, 0, -.02), (.09, .24, .02), "book_red")],
        "book_blue": [box((-.08, 0, -.025), (.08, .2, .025), "book_blue")],
        "chest": [box((-.35, 0, -.2), (.35, .45, .2), "chest")],
        "column": [lathe([(0, 0), *((.15, y) for y in (0, .9, 1.8, HEIGHT)), (0, HEIGHT)], 16, lambda k: "column")],
        "ball": [sphere(.12, 12, 8, "ball")],
        "lamp_1": lamp_parts(.6, "shade", "light_1"), "lamp_2": lamp_parts(.4, "plate", "light_2"),
        "lamp_3": lamp_parts(.4, "plate", "light_3"), "lamp_4": lamp_parts(.6, "shade", "light_4")}
    nodes = [
        Node("room", "room"), Node("table", "table", (2.5, 0, 2.1), 12.7),
        Node("chair_1", "chair", (2.3, 0, 2.95), 18.1), Node("chair_2", "chair", (3.05, 0, 2.75), 4.9),
        Node("chair_3", "chair", (2.75, 0, 1.25), 187.3), Node("chair_4", "chair", (1.95, 0, 1.45), 201.6),
        Node("shelf", "shelf", (0, 0, 1.3)),
        Node("book_1", "book_red", (.16, .6, 1.45), 7.3), Node("book_2", "book_blue", (.15, .6, 1.56), -11.2),
        Node("book_3", "book_red", (.17, 1.18, 1.95), 31.9), Node("book_4", "book_blue", (.16, .6, 2.1), 3.7),
        Node("chest", "chest", (3.3, 0, .45), 21.6), Node("column", "column", (.8, 0, .6)),
        Node("ball", "ball", (2.15, .75, 2.1)),
        Node("lamp_1", "lamp_1", (1.4, HEIGHT, 1), 9.1), Node("lamp_2", "lamp_2", (3.8, HEIGHT, 1.3), -21.3),
        Node("lamp_3", "lamp_3", (1.3, HEIGHT, 3.1), 37.7), Node("lamp_4", "lamp_4", (3.7, HEIGHT, 3), 0)]
    return Scene("table_room",
                 ["Metres. A room with a table, chairs, a shelf with books, a chest, a column, a ball and four lamps.",
                  "The room faces inwards; all else is made of closed parts that touch and do not overlap."],
                 materials, meshes, nodes, Camera((4.85, 1.65, 3.8), (2.1, .85, 1.6), math.radians(55), 1.333333))


# ---- Images on surfaces

def image(width, height, channels, colour):
    """`colour(x, y)` is a texel's values, 0 to 255."""
    texels = (colour(x, y) for y in range(height) for x in range(width))
    return Image(width, height, channels, bytes(value for texel in texels for value in texel))


def in_leaf(x, y):
    """A leaf with lobes and holes, in the unit square."""
    angle, radius = math.atan2(y - .5, x - .5), math.hypot(x - .5, y - .5)
    hole = any(math.hypot(x - a, y - b) < .07 for a, b in ((.35, .4), (.62, .36), (.55, .68)))
    return radius < .36 + .12 * math.cos(5 * angle) and not hole


def textured_images():
    def plaster(x, y):  # a checker over a gradient
        shade = 70 + 160 * y // 47
        return (shade, shade, 230) if (x // 8 + y // 8) % 2 else (240, shade, 60)

    def tile(x, y):
        return (90, 88, 84) if x == 0 or y == 0 else (176, 96, 60) if (x < 16) == (y < 16) else (222, 206, 176)

    def screen(x, y):  # bars
        return ((255, 255, 255), (255, 220, 0), (0, 200, 255), (0, 0, 0))[x // 8] if 2 <= y < 14 else (0, 0, 0)

    def leaf(x, y):
        inside = in_leaf((x + .5) / 64, (y + .5) / 64)
        return (70, 150, 50, 255) if inside else (70, 150, 50, 0)
    return {"textured_room_plaster.png": image(96, 48, 3, plaster), "textured_room_tile.png": image(32, 32, 3, tile),
            "textured_room_screen.png": image(32, 16, 3, screen), "textured_room_leaf.png": image(64, 64, 4, leaf)}


def textured_room():
    names = {"y0": "floor", "z0": "plaster"}
    room = box((0, 0, 0), (3, 2.4, 3), lambda side: names.get(side, "wall"), inward=True)
    screen = box((2.96, .7, 1), (3, 1.5, 2.4), lambda side: "screen" if side == "x0" else "frame")
    lamp = box((1.4, 2.35, 1.4), (1.6, 2.4, 1.6), lambda side: "lamp" if side == "y0" else "frame")
    leaf = [("leaf", [(.9, 1.3, 1), (.9, 1.3, 2), (1.9, 1.3, 2), (1.9, 1.3, 1)])]
    materials = {
        "wall": Material((.7, .7, .7)), "frame": Material((.2, .2, .2)), "lamp": Material((.7, .7, .7), (60, 55, 45)),
        "plaster": Material((.9, .9, .9), kd_image="textured_room_plaster.png",
                            mapping=Mapping((1 / 3, 0, 0, 0), (0, -1 / 2.4, 0, 1))),
        "floor": Material((.9, .9, .9), kd_image="textured_room_tile.png",  # a tile of .6 m, turned by 30 degrees
                          mapping=Mapping((1.44337567, 0, .83333333, 0), (-.83333333, 0, 1.44337567, 0))),
        "screen": Material((.05, .05, .05), (2, 2, 2), ke_image="textured_room_screen.png",
                           mapping=Mapping((0, 0, 1 / 1.4, -1 / 1.4), (0, -1 / .8, 0, 1.5 / .8))),
        "leaf": Material((1, 1, 1), kd_image="textured_room_leaf.png", cutout=True,
                         mapping=Mapping((1, 0, 0, -.9), (0, 0, 1, -1)))}
    meshes = {"room": [room], "screen": [screen], "lamp": [lamp], "leaf": [leaf]}
    return Scene("textured_room",
                 ["Metres. A closed room: a plastered wall, a floor of tiles that repeat, a screen that emits an image,",
                  "and under a small lamp a leaf that is cut out of a square by the opacity of its image."],
                 materials, meshes, [Node(name, name) for name in meshes],
                 Camera((.3, 1.9, 2.85), (1.75, .85, 1.05), math.radians(62), 1.333333), textured_images())


# ---- A room for daylight

def window_room():
    width, height, depth = 4, 2.8, 5
    left, right, sill, top, outside = .8, 3.2, .8, 2.3, depth + .3
    names = {"x0": "wall_west", "x1": "wall_east", "y0": "floor", "y1": "ceiling"}
    room = box((0, 0, 0), (width, height, depth), lambda side: names.get(side, "wall"), inward=True)[:5]

    def facing_north(x0, x1, y0, y1):
        return ("wall", [(x1, y0, depth), (x0, y0, depth), (x0, y1, depth), (x1, y1, depth)])
    room += [facing_north(0, left, 0, height), facing_north(right, width, 0, height),
             facing_north(left, right, 0, sill), facing_north(left, right, top, height)]
    reveal = box((left, sill, depth), (right, top, outside), "reveal", inward=True)[:4]
    materials = {
        "floor": Material((.45, .33, .22)), "ceiling": Material((.82, .82, .8)), "wall": Material((.7, .69, .66)),
        "wall_west": Material((.62, .3, .22)), "wall_east": Material((.25, .42, .55)), "reveal": Material((.8, .8, .8)),
        "table": Material((.5, .34, .2)), "box": Material((.6, .6, .58)), "panel": Material((.7, .7, .7), (500, 450, 350))}
    meshes = {
        "room": [room + reveal],
        "table": [box((-.7, .71, -.4), (.7, .75, .4), "table"), *legs(.66, .36, .06, .71, "table")],
        "box": [box((-.25, 0, -.25), (.25, .5, .25), "box")],
        "panel": [box((-.3, -.04, -.3), (.3, 0, .3), lambda side: "panel" if side == "y0" else "box")]}
    nodes = [Node("room", "room"), Node("table", "table", (1.6, 0, 3.1), 8.3), Node("box", "box", (3.2, 0, 1.1), 21.7),
             Node("panel", "panel", (2, height, 1.2))]
    cones = (.35, .6)
    lights = [Light("bulb", "point", 60, (1, .85, .6), (.9, 1.3, .8)),
              Light("spot", "spot", 400, (1, .95, .9), (.7, 2.7, 2), (-.6, -1, 0), cones),
              Light("spot", "spot", 400, (1, .95, .9), (.7, 2.7, 3.4), (-.6, -1, 0), cones)]
    return Scene("window_room",
                 ["Metres; north is -z, east +x. A room with a window to the south and no pane in it, a table, a box, a",
                  "panel under the ceiling, and lights without area: a bulb and two spots of one name."],
                 materials, meshes, nodes, Camera((.35, 1.75, .3), (2.3, .9, 3.6), math.radians(62), 1.333333),
                 lights=lights)


# ---- Rooms that are hard for virtual point lights

def rectangle(axis, at, low, high, material, up):
    """A rectangle across an axis, `low` and `high` being its corners in the other two, in the order x y z; its front points up the
    axis, or else down."""
    (a0, b0), (a1, b1) = low, high
    corners = [(a0, b0), (a1, b0), (a1, b1), (a0, b1)]
    points = [(*corner[:axis], at, *corner[axis:]) for corner in corners]
    return (material, points if up == (axis != 1) else points[::-1])


def corridor():
    """A lit room, and a corridor along it that gets all its light through a door."""
    wide, deep, height, wall, far = 3, 4, 2.5, .15, 4.4
    door = ((0, 1.5), (2.05, 2.4))  # y and z
    names = {"x0": "room_wall", "y0": "floor", "y1": "ceiling", "z0": "room_wall", "z1": "room_wall"}
    room = [face for face in box((0, 0, 0), (wide, height, deep), lambda side: names.get(side, ""), inward=True) if face[0]]
    names = {"x1": "wall", "y0": "floor", "y1": "ceiling", "z0": "wall", "z1": "wall"}
    hall = [face for face in box((wide + wall, 0, -2), (far, height, 6), lambda side: names.get(side, ""), inward=True)
            if face[0]]

    def wall_with_door(x, z0, z1, material, up):
        (y0, left), (top, right) = door
        return [rectangle(0, x, (y0, z0), (height, left), material, up),
                rectangle(0, x, (y0, right), (height, z1), material, up),
                rectangle(0, x, (top, left), (height, right), material, up)]
    room += wall_with_door(wide, 0, deep, "room_wall", False)
    hall += wall_with_door(wide + wall, -2, 6, "wall", True)
    (y0, left), (top, right) = door
    names = {"y0": "floor"}
    frame = box((wide, y0, left), (wide + wall, top, right), lambda side: names.get(side, "frame"), inward=True)[2:]
    materials = {"room_wall": Material((.75, .6, .4)), "wall": Material((.7, .72, .75)), "floor": Material((.4, .35, .3)),
                 "ceiling": Material((.8, .8, .8)), "frame": Material((.55, .4, .3)), "lamp": Material((.7, .7, .7), (40, 36, 30))}
    lamp = box((1.2, height - .05, 1.7), (1.8, height, 2.3), lambda side: "lamp" if side == "y0" else "frame")
    meshes = {"room": [room], "corridor": [hall], "door": [frame], "lamp": [lamp]}
    return Scene("corridor",
                 ["Metres. A room of 3 x 4 x 2.5 m with a lamp, and a corridor of 8 m along it behind a wall of 15 cm:",
                  "all its light comes through a door of 0.9 x 2.05 m."],
                 materials, meshes, [Node(name, name) for name in meshes],
                 Camera((3.75, 1.6, 5.7), (3.6, 1.1, 1.2), math.radians(65), 1.333333))


def cove_room():
    """A room lit from a cove: all light comes out of a gap below the ceiling."""
    wide, height, deep = 4, 2.5, 3
    shelf, gap, depth, strip = 2.3, .15, .3, .08
    names = {"y0": "floor", "y1": "ceiling", "x1": "wall_end"}
    room = box((0, 0, 0), (wide, height, deep), lambda side: names.get(side, "wall"), inward=True)[1:]
    room += [rectangle(0, 0, (0, 0), (shelf, deep), "wall", True), rectangle(0, 0, (height - gap, 0), (height, deep), "wall", True)]
    cove = [rectangle(1, height - gap, (0, 0), (strip, deep), "lamp", True),
            rectangle(1, height - gap, (strip, 0), (depth, deep), "shelf", True),
            rectangle(0, depth, (shelf, 0), (height - gap, deep), "shelf", True),
            rectangle(1, shelf, (0, 0), (depth, deep), "shelf", False)]
    materials = {"wall": Material((.7, .69, .66)), "wall_end": Material((.6, .3, .24)), "floor": Material((.45, .33, .22)),
                 "ceiling": Material((.82, .82, .8)), "shelf": Material((.75, .75, .75)), "lamp": Material((.6, .6, .6), (60, 52, 40))}
    meshes = {"room": [room], "cove": [cove]}
    return Scene("cove_room",
                 ["Metres. A closed room of 4 x 2.5 x 3 m that is lit from a cove: a strip of light on a shelf, 15 cm below the",
                  "ceiling, along one wall. What leaves the gap has been reflected in it."],
                 materials, meshes, [Node(name, name) for name in meshes],
                 Camera((3.8, 1.5, 2.7), (.6, 1.4, 1.2), math.radians(65), 1.333333))


def block_of_rooms():
    """A house: closed rooms beside and above each other, a lamp in each."""
    size, wall, lamp, drop = (4, 2.6, 4), .2, 1.2, .05
    names = {"y0": "floor", "y1": "ceiling"}
    faces = []
    for room in itertools.product(range(3), repeat=3):
        low = [k * (extent + wall) for k, extent in zip(room, size)]
        high = [a + extent for a, extent in zip(low, size)]
        faces += box(low, high, lambda side: names.get(side, "wall"), inward=True)
        (x0, x1), (z0, z1) = ([(a + b + sign * lamp) / 2 for sign in (-1, 1)] for a, b in ((low[0], high[0]), (low[2], high[2])))
        for material, up in (("lamp", False), ("ceiling", True)):
            faces.append(rectangle(1, high[1] - drop, (x0, z0), (x1, z1), material, up))
    materials = {"wall": Material((.7, .7, .7)), "floor": Material((.42, .42, .42)), "ceiling": Material((.8, .8, .8)),
                 "lamp": Material((.5, .5, .5), (10, 10, 10))}
    return Scene("block_of_rooms",
                 ["Metres. 27 closed rooms of 4 x 2.6 x 4 m, three each way, with walls of 20 cm between them; in each a lamp of",
                  "1.2 x 1.2 m, 5 cm below the ceiling. A line through the house passes several rooms."],
                 materials, {"rooms": [faces]}, [Node("rooms", "rooms")],
                 Camera((.3, 1.6, .3), (3, 1, 3), math.radians(75), 1.333333))


def scenes():
    """Every scene, with the file formats it is written in."""
    both = ("gltf", "obj")
    return [(cornell_box(), (*both, "mgf")), (furnace_box(), (*both, "ply", "stl")), (table_room(), (*both, "mgf")),
            (textured_room(), both), (window_room(), ("gltf",)), (corridor(), ("gltf",)),
            (cove_room(), ("gltf",)), (block_of_rooms(), ("obj",)),
            *((case, ("obj", "mgf") if case.name == "cube6" else ("obj",)) for case in analytic_cases())]


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent
    for scene, formats in scenes():
        for file_format in formats:
            WRITERS[file_format](scene, folder)


if __name__ == "__main__":
    main()
