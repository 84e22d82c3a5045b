"""What a scene of data/generate.py is made of, and how it is written as OBJ, as glTF and as MGF."""
import base64
import json
import math
import struct
import zlib
from typing import NamedTuple

# A part is a list of faces, a face is a pair (material, corners). Every part of a movable object is convex and closed.


class Image(NamedTuple):
    width: int
    height: int
    channels: int           # 3, or 4 with opacity
    values: bytes           # sRGB, row by row from the top


class Mapping(NamedTuple):
    """Texture coordinates as functions of a mesh's points: u = ux x + uy y + uz z + u0, and v, which runs downwards."""
    u: tuple
    v: tuple

    def at(self, point):
        return tuple(rounded(sum(a * b for a, b in zip(row, (*point, 1)))) for row in (self.u, self.v))


class Material(NamedTuple):
    kd: tuple               # diffuse reflectance, RGB; times kd_image
    ke: tuple = (0, 0, 0)   # emitted radiance, RGB; the emitted radiosity is pi times this; times ke_image
    kd_image: str = ""      # names of images of the scene
    ke_image: str = ""
    mapping: Mapping = None
    cutout: bool = False    # holes where kd_image's opacity is below 1/2; two-sided, which OBJ does not know


class Node(NamedTuple):
    name: str
    mesh: str               # several nodes may show one mesh
    position: tuple = (0, 0, 0)
    yaw: float = 0          # degrees about y


class Camera(NamedTuple):
    eye: tuple
    look_at: tuple
    vertical_fov: float     # radians
    aspect: float


class Light(NamedTuple):
    """A light without area, which only glTF knows. Several of one name are one light at several places."""
    name: str
    kind: str               # point or spot
    intensity: float        # candela
    colour: tuple
    position: tuple
    direction: tuple = (0, -1, 0)
    cones: tuple = (0, 0)   # half angles, radians: full light inside the first, none outside the second


class Scene(NamedTuple):
    name: str
    comment: list           # lines
    materials: dict         # name -> Material
    meshes: dict            # name -> list of parts
    nodes: list
    camera: Camera = None
    images: dict = {}       # name -> Image
    lights: list = []


def rounded(x):
    return round(x, 8) + 0.0  # + 0.0 turns -0.0 into 0.0


def placed(node, point):
    """A mesh's point in the scene."""
    c, s = math.cos(math.radians(node.yaw)), math.sin(math.radians(node.yaw))
    x, y, z = point
    if node.yaw:
        x, z = c * x + s * z, c * z - s * x
    return tuple(rounded(a + b) for a, b in zip((x, y, z), node.position))


def number(x):
    return f"{x:.12g}"


def short_float(x):
    """The shortest decimal that is `x` in single precision."""
    single = struct.pack("<f", x)
    return next(float(text) for text in (f"{x:.{digits}g}" for digits in range(1, 10))
                if struct.pack("<f", float(text)) == single)


def write_png(image, path):
    """Without compression: the same bytes whatever the version of zlib."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    row = image.width * image.channels
    rows = b"".join(b"\0" + image.values[i:i + row] for i in range(0, len(image.values), row))
    header = struct.pack(">2I5B", image.width, image.height, 8, {3: 2, 4: 6}[image.channels], 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 0))
                     + chunk(b"IEND", b""))


def write_images(scene, folder):
    for name, image in scene.images.items():
        write_png(image, folder / name)


def write_obj(scene, folder):
    write_images(scene, folder)
    lines = [f"# {line}" for line in scene.comment] + [f"mtllib {scene.name}.mtl"]
    count, uv_index = 0, {}
    for node in scene.nodes:
        lines.append(f"o {node.name}")
        index, faces, current = {}, [], None
        known_uvs = len(uv_index)
        for material, points in (face for part in scene.meshes[node.mesh] for face in part):
            if material != current:
                faces.append(f"usemtl {material}")
                current = material
            corners = [str(index.setdefault(placed(node, p), len(index) + 1) + count) for p in points]
            mapping = scene.materials[material].mapping
            if mapping:
                uvs = [uv_index.setdefault(mapping.at(p), len(uv_index) + 1) for p in points]
                corners = [f"{corner}/{uv}" for corner, uv in zip(corners, uvs)]
            faces.append("f " + " ".join(corners))
        lines += ["v " + " ".join(map(number, p)) for p in index]
        lines += [f"vt {number(u)} {number(1 - v)}" for u, v in list(uv_index)[known_uvs:]] + faces
        count += len(index)
    (folder / f"{scene.name}.obj").write_text("\n".join(lines) + "\n")

    lines = [f"# {scene.comment[0]}"]
    for name, material in scene.materials.items():
        lines += [f"newmtl {name}"]
        lines += [f"{key} " + " ".join(map(number, value)) for key, value in (("Kd", material.kd), ("Ke", material.ke))]
        images = {"map_Kd": material.kd_image, "map_Ke": material.ke_image,
                  "map_d": material.kd_image if material.cutout else ""}
        lines += [f"{key} {image}" for key, image in images.items() if image]
    (folder / f"{scene.name}.mtl").write_text("\n".join(lines) + "\n")


# ---- MGF: colours as CIE chromaticities and luminances. Its white, the equal-energy white E, stands for R = G = B, so that
# colours are adapted from Rec. 709's white D65 to E by the Bradford transform.

REC709 = ((.64, .33), (.30, .60), (.15, .06))
WHITE_D65, WHITE_E = (.3127, .3290), (1 / 3, 1 / 3)
LUMINANCE = (.2126, .7152, .0722)
BRADFORD = ((.8951, .2664, -.1614), (-.7502, 1.7135, .0367), (.0389, -.0685, 1.0296))


def times(matrix, vector):
    return tuple(sum(a * b for a, b in zip(row, vector)) for row in matrix)


def solved(matrix, right):
    """The vector that the 3x3 matrix turns into `right`, by Cramer's rule."""
    def determinant(m):
        return sum(m[0][i] * (m[1][i - 2] * m[2][i - 1] - m[1][i - 1] * m[2][i - 2]) for i in range(3))
    return tuple(determinant([[*row[:k], r, *row[k + 1:]] for row, r in zip(matrix, right)]) / determinant(matrix)
                 for k in range(3))


def xyz_of(x, y):
    return (x / y, 1, (1 - x - y) / y)


def chromaticity(rgb):
    """CIE x, y of a linear Rec. 709 colour, relative to the white E."""
    primaries = list(zip(*(xyz_of(*xy) for xy in REC709)))
    shares = solved(primaries, xyz_of(*WHITE_D65))
    cones = times(BRADFORD, times(primaries, [share * c for share, c in zip(shares, rgb)]))
    d65, e = (times(BRADFORD, xyz_of(*white)) for white in (WHITE_D65, WHITE_E))
    xyz = solved(BRADFORD, [c * to / of for c, to, of in zip(cones, e, d65)])
    return xyz[0] / sum(xyz), xyz[1] / sum(xyz)


def mgf_colour(keyword, rgb, factor=1):
    """The colour context, and the entity that uses it."""
    luminance = sum(weight * c for weight, c in zip(LUMINANCE, rgb))
    if luminance == 0:
        return [f"\t{keyword} 0"]
    context = "\tc" if len(set(rgb)) == 1 else "\tc\n\t\tcxy " + " ".join(map(number, chromaticity(rgb)))
    return [context, f"\t{keyword} {number(factor * luminance)}"]


def write_mgf(scene, folder):
    """One object per node, one vertex per corner of an object, one-sided materials."""
    lines = [f"# {line}" for line in scene.comment]
    for name, material in scene.materials.items():
        lines += [f"m {name} =", "\tsides 1", *mgf_colour("rd", material.kd)]
        if any(material.ke):
            lines += mgf_colour("ed", material.ke, math.pi)  # emittance is pi times the radiance
    for node in scene.nodes:
        vertices, faces, current = {}, [], None
        for material, points in (face for part in scene.meshes[node.mesh] for face in part):
            if material != current:
                faces.append(f"m {material}")
                current = material
            faces.append("f " + " ".join(vertices.setdefault(placed(node, p), f"{node.name}.{len(vertices)}")
                                         for p in points))
        lines.append(f"o {node.name}")
        for point, name in vertices.items():
            lines += [f"v {name} =", "\tp " + " ".join(map(number, point))]
        lines += [*faces, "o"]
    (folder / f"{scene.name}.mgf").write_text("\n".join(lines) + "\n")


def gltf_material(name, material, images):
    entry = {"name": name, "pbrMetallicRoughness": {
        "baseColorFactor": [*material.kd, 1], "metallicFactor": 0, "roughnessFactor": 1}}
    brightest = max(material.ke)
    if brightest > 0:  # emissiveFactor ends at 1; a round strength keeps it short
        strength = next(s for s in (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000) if s >= brightest)
        entry["emissiveFactor"] = [float(number(k / strength)) for k in material.ke]
        if strength > 1:
            entry["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}
    if material.kd_image:
        entry["pbrMetallicRoughness"]["baseColorTexture"] = {"index": images.index(material.kd_image)}
    if material.ke_image:
        entry["emissiveTexture"] = {"index": images.index(material.ke_image)}
    if material.cutout:
        entry |= {"alphaMode": "MASK", "alphaCutoff": 0.5, "doubleSided": True}
    return entry


def gltf_rotation(direction):
    """Turns -z to the direction."""
    dx, dy, dz = direction
    yaw = math.atan2(-dx, -dz) / 2 if dx or dz else 0
    pitch = math.atan2(dy, math.hypot(dx, dz)) / 2
    return [rounded(q) for q in (math.cos(yaw) * math.sin(pitch), math.sin(yaw) * math.cos(pitch),
                                 -math.sin(yaw) * math.sin(pitch), math.cos(yaw) * math.cos(pitch))]


def gltf_camera_node(camera):
    rotation = gltf_rotation(b - a for a, b in zip(camera.eye, camera.look_at))
    return {"name": "camera", "camera": 0, "translation": list(camera.eye), "rotation": rotation}


def gltf_lights(lights):
    """What the lights' extension holds, and the nodes that show them."""
    definitions, nodes = {}, []
    for light in lights:
        entry = {"name": light.name, "type": light.kind, "color": list(light.colour), "intensity": light.intensity}
        if light.kind == "spot":
            entry["spot"] = {"innerConeAngle": rounded(light.cones[0]), "outerConeAngle": rounded(light.cones[1])}
        definitions[light.name] = entry
        node = {"name": light.name, "translation": list(light.position)}
        if light.kind == "spot":
            node["rotation"] = gltf_rotation(light.direction)
        nodes.append(node | {"extensions": {"KHR_lights_punctual": {"light": list(definitions).index(light.name)}}})
    return list(definitions.values()), nodes


def write_gltf(scene, folder):
    """One node per object, one primitive per material, triangles fanned from a face's first corner."""
    write_images(scene, folder)
    positions, indices, uvs, accessors, meshes = b"", b"", b"", [], []
    materials = list(scene.materials)
    for mesh, parts in scene.meshes.items():
        primitives = []
        faces = [face for part in parts for face in part]
        for material in dict.fromkeys(material for material, _ in faces):
            index, triangles = {}, []
            for _, points in (face for face in faces if face[0] == material):
                corners = [index.setdefault(tuple(p), len(index)) for p in points]
                for k in range(1, len(corners) - 1):
                    triangles += [corners[0], corners[k], corners[k + 1]]
            primitives.append({"attributes": {"POSITION": len(accessors)}, "indices": len(accessors) + 1,
                               "material": materials.index(material)})
            accessors.append({"bufferView": 0, "byteOffset": len(positions), "componentType": 5126, "type": "VEC3",
                              "count": len(index), "min": [short_float(min(axis)) for axis in zip(*index)],
                              "max": [short_float(max(axis)) for axis in zip(*index)]})
            accessors.append({"bufferView": 1, "byteOffset": len(indices), "componentType": 5123, "type": "SCALAR",
                              "count": len(triangles)})
            positions += b"".join(struct.pack("<3f", *p) for p in index)
            indices += struct.pack(f"<{len(triangles)}H", *triangles)
            mapping = scene.materials[material].mapping
            if mapping:
                primitives[-1]["attributes"]["TEXCOORD_0"] = len(accessors)
                accessors.append({"bufferView": 2, "byteOffset": len(uvs), "componentType": 5126, "type": "VEC2",
                                  "count": len(index)})
                uvs += b"".join(struct.pack("<2f", *mapping.at(p)) for p in index)
        meshes.append({"name": mesh, "primitives": primitives})

    nodes = []
    for node in scene.nodes:
        entry = {"name": node.name, "mesh": list(scene.meshes).index(node.mesh)}
        if any(node.position):
            entry["translation"] = list(node.position)
        if node.yaw:
            half = math.radians(node.yaw) / 2
            entry["rotation"] = [0, rounded(math.sin(half)), 0, rounded(math.cos(half))]
        nodes.append(entry)
    gltf = {"asset": {"version": "2.0", "generator": "Lambert, data/generate.py", "extras": {"comment": scene.comment}}}
    gltf_materials = [gltf_material(name, material, list(scene.images)) for name, material in scene.materials.items()]
    used = ["KHR_materials_emissive_strength"] if any("extensions" in m for m in gltf_materials) else []
    if scene.lights:
        used.append("KHR_lights_punctual")
        definitions, light_nodes = gltf_lights(scene.lights)
        nodes += light_nodes
        gltf["extensions"] = {"KHR_lights_punctual": {"lights": definitions}}
    if used:
        gltf["extensionsUsed"] = used
    if scene.camera:
        nodes.append(gltf_camera_node(scene.camera))
        gltf["cameras"] = [{"name": "camera", "type": "perspective", "perspective": {
            "yfov": round(scene.camera.vertical_fov, 8), "aspectRatio": scene.camera.aspect, "znear": 0.01}}]
    data = positions + indices
    if uvs:
        data += bytes(-len(data) % 4)
    gltf |= {"scene": 0, "scenes": [{"name": scene.name, "nodes": list(range(len(nodes)))}], "nodes": nodes,
             "meshes": meshes, "materials": gltf_materials, "accessors": accessors,
             "bufferViews": [
                 {"buffer": 0, "byteLength": len(positions), "byteStride": 12, "target": 34962},
                 {"buffer": 0, "byteOffset": len(positions), "byteLength": len(indices), "target": 34963}],
             "buffers": [{"byteLength": len(data) + len(uvs), "uri": "data:application/octet-stream;base64,"
                          + base64.b64encode(data + uvs).decode()}]}
    if uvs:
        gltf["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": len(uvs), "byteStride": 8,
                                    "target": 34962})
        gltf["images"] = [{"uri": name} for name in scene.images]
        gltf["textures"] = [{"source": k, "sampler": 0} for k in range(len(scene.images))]
        gltf["samplers"] = [{"magFilter": 9728, "minFilter": 9728}]  # texels are squares

    def dump(value):
        return json.dumps(value, separators=(", ", ": "))
    entries = []
    for key, value in gltf.items():  # one element of a list per line
        if isinstance(value, list) and isinstance(value[0], dict):
            entries.append(f'"{key}": [\n  ' + ",\n  ".join(map(dump, value)) + "\n]")
        else:
            entries.append(f'"{key}": {dump(value)}')
    (folder / f"{scene.name}.gltf").write_text("{\n" + ",\n".join(entries) + "\n}\n")
