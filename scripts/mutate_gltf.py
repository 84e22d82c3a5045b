#!/usr/bin/env python3
"""Makes malformed glTF files from one sound scene: mutate_gltf.py FOLDER [--count N] [--seed S].

Every file is hostile in one way: what no exporter writes but somebody will send. First come the named cases, then
members of the wrong JSON type at every place in turn, then flipped bytes. The same seed gives the same files.
"""
import base64
import copy
import json
import random
import struct
import sys


from mutation import SOUND_NAME, Case, flipped, main
from sample_gltf import BINARY, COORDINATES, IMAGE, POSITIONS, chunk, data_uri, floats, glb, gltf, png, sound_document


# ---- Named cases

def changed(*changes):
    """The sound document with members set: changed("/nodes/0/mesh", 7); a value of ... removes the member."""
    document = sound_document()
    for path, value in zip(changes[::2], changes[1::2]):
        *way, last = [int(part) if part.isdigit() else part for part in path.strip("/").split("/")]
        place = document
        for part in way:
            place = place.setdefault(part, {}) if isinstance(place, dict) else place[part]
        if value is ...:
            del place[last]
        elif isinstance(place, list) and last == len(place):
            place.append(value)
        else:
            place[last] = value
    return document


def coordinate_cases():
    for name, value in {"nan": float("nan"), "infinite": float("inf"), "huge": 3e38, "tiny": 1e-42, "far": 1e30}.items():
        for where, numbers in {"one": (value, 0, 0), "all": (value,) * 12}.items():
            yield f"position_{name}_{where}", gltf(sound_document(), floats(*numbers) + BINARY[4 * len(numbers):])
        yield f"coordinate_{name}", gltf(sound_document(), BINARY[:48] + floats(value) + BINARY[52:])
    for name, value in {"zero": [0, 0, 0], "huge": [1e38] * 3, "tiny": [1e-38] * 3, "mirrored": [-1, 1, 1],
                        "double": [1e200] * 3, "flat": [1, 0, 1]}.items():
        yield f"scale_{name}", gltf(changed("/nodes/0/scale", value))
    yield "rotation_zero", gltf(changed("/nodes/2/rotation", [0, 0, 0, 0]))
    yield "rotation_huge", gltf(changed("/nodes/2/rotation", [1e30, 1e30, 0, 0]))
    yield "matrix_singular", gltf(changed("/nodes/3/matrix", [0] * 16))
    yield "matrix_projective", gltf(changed("/nodes/3/matrix", [1] * 16))
    yield "matrix_and_scale", gltf(changed("/nodes/0/matrix", [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]))
    yield "not_numbers", gltf(sound_document()).replace(b"0.9", b"NaN")
    yield "infinity_in_json", gltf(sound_document()).replace(b"0.9", b"Infinity")
    yield "number_beyond_double", gltf(sound_document()).replace(b"0.9", b"9e999")
    yield "number_of_10000_digits", gltf(sound_document()).replace(b"0.9", b"9" * 10000)


def accessor_cases():
    out_of_range = POSITIONS + COORDINATES + struct.pack("<6H", 0, 1, 4, 0, 65535, 3) + IMAGE
    yield "index_out_of_range", gltf(sound_document(), out_of_range)
    for member in ("bufferView", "componentType", "count", "byteOffset"):
        for value in (-1, 1, 3, 99, 2**31, 2**32 - 1, 2**53, 2**64):
            for accessor in (0, 2):
                yield f"accessor{accessor}_{member}_{value}", glb(changed(f"/accessors/{accessor}/{member}", value))
    for kind in ("SCALAR", "VEC2", "VEC4", "MAT4", "VEC5", ""):
        yield f"accessor_type_{kind or 'empty'}", gltf(changed("/accessors/0/type", kind))
    for component in (5120, 5121, 5122, 5123, 5124, 5125, 5126):
        yield f"positions_of_{component}", gltf(changed("/accessors/0/componentType", component))
        yield f"indices_of_{component}", gltf(changed("/accessors/2/componentType", component))
    for member in ("buffer", "byteOffset", "byteLength", "byteStride"):
        for value in (-1, 0, 1, 3, 49, 255, 2**32, 2**53, 2**64 - 1):
            yield f"view_{member}_{value}", glb(changed(f"/bufferViews/0/{member}", value))
    for value in (-1, 0, 1, 2**32, 2**53, 2**64 - 1):
        yield f"buffer_length_{value}", glb(changed("/buffers/0/byteLength", value))
    yield "count_4_gb_without_view", gltf(changed("/accessors/0/bufferView", ..., "/accessors/0/count", 2**32 - 2,
                                                  "/accessors/2/bufferView", ..., "/accessors/2/count", 2**32 - 2))
    yield "count_1_g_without_view", gltf(changed("/accessors/0/bufferView", ..., "/accessors/0/count", 10**9))
    yield "indices_1_g_without_view", gltf(changed("/accessors/2/bufferView", ..., "/accessors/2/count", 999999999))
    yield "buffers_without_bytes", gltf(changed("/buffers/0/uri", "data:application/octet-stream;base64,"))
    for name, uri in {"comma": "data:application/octet-stream;base64", "characters": data_uri(BINARY)[:-9] + "*&^%$#@!",
                      "plain": "data:,hello", "mime": "data:image/png;base64,AAAA", "empty": "", "dot": ".",
                      "scheme": "file:///etc/passwd", "remote": "https://example.org/x.bin"}.items():
        yield f"buffer_uri_{name}", gltf(changed("/buffers/0/uri", uri))


def sparse_cases():
    """The last vertex of the positions is replaced through a sparse accessor."""
    sound = {"count": 1, "indices": {"bufferView": 2, "byteOffset": 2, "componentType": 5123},
             "values": {"bufferView": 0, "byteOffset": 12}}
    yield "sparse", gltf(changed("/accessors/0/sparse", sound))
    yield "sparse_without_view", gltf(changed("/accessors/0/sparse", sound, "/accessors/0/bufferView", ...))
    for path, values in {"count": (-1, 0, 5, 2**32, 2**62), "indices/bufferView": (-1, 9), "indices/byteOffset": (11, 2**63),
                         "indices/componentType": (5126, 5124, 0), "values/bufferView": (-1, 9),
                         "values/byteOffset": (47, -1, 2**62)}.items():
        for value in values:
            yield (f"sparse_{path.replace('/', '_')}_{value}",
                   gltf(changed("/accessors/0/sparse", copy.deepcopy(sound), f"/accessors/0/sparse/{path}", value)))
    unordered = POSITIONS + COORDINATES + struct.pack("<6H", 3, 1, 1, 0, 60000, 3) + IMAGE
    for count in (3, 6):
        yield f"sparse_unordered_{count}", gltf(changed("/accessors/0/sparse", {
            "count": count, "indices": {"bufferView": 2, "componentType": 5123}, "values": {"bufferView": 0}}), unordered)


def node_cases():
    yield "node_own_child", gltf(changed("/nodes/0/children", [0]))
    yield "node_cycle", gltf(changed("/nodes/1/children", [2], "/nodes/2/children", [1]))
    yield "node_cycle_to_root", gltf(changed("/nodes/1/children", [0]))
    yield "node_with_two_parents", gltf(changed("/nodes/1/children", [2]))
    yield "node_twice_in_scene", gltf(changed("/scenes/0/nodes", [0, 0]))
    yield "node_twice_child", gltf(changed("/nodes/0/children", [1, 1, 1]))
    for value in (-1, 99, 2**31, 2**64):
        yield f"child_{value}", gltf(changed("/nodes/0/children", [value]))
        yield f"root_{value}", gltf(changed("/scenes/0/nodes", [value]))
        yield f"scene_{value}", gltf(changed("/scene", value))
        for member in ("mesh", "camera", "skin"):
            yield f"node_{member}_{value}", gltf(changed(f"/nodes/1/{member}", value))
    chain = [{"children": [k + 1]} for k in range(100_000)] + [{"mesh": 0}]
    yield "nodes_nested_100000", gltf(changed("/nodes", chain))
    shrinking = [{"children": [k + 1], "scale": [0.5] * 3} for k in range(2000)] + [{"mesh": 0}]
    yield "nodes_shrinking_2000", gltf(changed("/nodes", shrinking))
    growing = [{"children": [k + 1], "scale": [2] * 3} for k in range(2000)] + [{"mesh": 0}]
    yield "nodes_growing_2000", gltf(changed("/nodes", growing))
    yield "no_scenes", gltf(changed("/scenes", ..., "/scene", ...))
    for member in ("scenes", "nodes", "meshes", "accessors", "bufferViews", "buffers", "materials", "images", "textures",
                   "cameras", "samplers"):
        yield f"{member}_empty", gltf(changed(f"/{member}", []))
        yield f"{member}_missing", gltf(changed(f"/{member}", ...))
    yield "primitives_empty", gltf(changed("/meshes/0/primitives", [], "/meshes/1/primitives", []))


def multiplied_cases():
    """A few kilobytes that mean billions of polygons: each node shows each primitive of a mesh."""
    primitive = {"attributes": {"POSITION": 0}, "indices": 0}
    for nodes, primitives, triangles in ((300, 300, 1), (300, 300, 3000), (2000, 1000, 10000)):
        indices = struct.pack("<3H", 0, 1, 2) * triangles
        document = {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(nodes))}],
            "nodes": [{"mesh": 0}] * nodes,
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}] * primitives}],
            "materials": [{"name": "light", "emissiveFactor": [1, 1, 1]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                          {"bufferView": 1, "componentType": 5123, "count": 3 * triangles, "type": "SCALAR"}],
            "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": len(indices)}],
            "buffers": [{"byteLength": 48 + len(indices)}]}
        yield f"multiplied_{nodes}_{primitives}_{triangles}", glb(document, POSITIONS + indices)
    # Two sets of many vertices take turns, of which each primitive uses three.
    many = struct.pack("<3f", 0, 0, 0) * 20_000
    turns = [{"attributes": {"POSITION": k % 2}, "indices": 2, "material": 0} for k in range(1000)]
    yield "vertices_unused", glb({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(1000))}], "nodes": [{"mesh": 0}] * 1000,
        "meshes": [{"primitives": turns}], "materials": [{"name": "light", "emissiveFactor": [1, 1, 1]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 20_000, "type": "VEC3"}] * 2 +
                     [{"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": len(many)}, {"buffer": 0, "byteOffset": len(many), "byteLength": 6}],
        "buffers": [{"byteLength": len(many) + 6}]}, POSITIONS + many[len(POSITIONS):] + struct.pack("<3H", 0, 1, 2))
    instancing = {"attributes": {"TRANSLATION": 0}}
    for count in (4, 10**6, 10**9):
        yield f"instances_{count}", gltf(changed(
            "/nodes/1/extensions", {"EXT_mesh_gpu_instancing": instancing}, "/accessors/3",
            {"componentType": 5126, "count": count, "type": "VEC3"},
            "/nodes/1/extensions/EXT_mesh_gpu_instancing/attributes/TRANSLATION", 3))
    yield "primitive_without_position", gltf(changed("/meshes/0/primitives/0", {**primitive, "attributes": {}}))


def image_cases():
    inside = "/images/0"
    for name, uri in {"missing": "missing.png", "above": "../../../../../../etc/passwd", "absolute": "/etc/passwd",
                      "encoded": "%2e%2e%2f%2e%2e%2f%2e%2e%2fetc%2fpasswd", "device": "/dev/zero", "self": "image_uri_self.gltf",
                      "folder": ".", "nul": "a\u0000b.png", "long": "x" * 5000, "percent": "%", "windows": "C:\\x.png",
                      "not_base64": "data:image/png;base64,****", "empty": "", "remote": "http://example.org/x.png",
                      "garbage": "data:image/png;base64," + base64.b64encode(b"not an image").decode()}.items():
        yield f"image_uri_{name}", gltf(changed(inside, {"uri": uri}))
        yield f"buffer_file_{name}", gltf(changed("/buffers/0/uri", uri))
    for name, content in {
            "zero_size": png(0, 0), "zero_width": png(0, 5), "cut": IMAGE[:-20], "header_only": IMAGE[:33],
            "gigapixel": IMAGE[:16] + struct.pack(">II", 2**31 - 1, 2**31 - 1) + IMAGE[24:],
            "large_promise": IMAGE[:16] + struct.pack(">II", 16384, 16384) + IMAGE[24:], "empty": b"",
            "jpeg_start": b"\xff\xd8\xff\xe0\0\x10JFIF", "bitmap": b"BM" + bytes(60), "exr": b"\x76\x2f\x31\x01" + bytes(60),
            "bomb": png(8192, 8192)}.items():
        uri = "data:image/png;base64," + base64.b64encode(content).decode()
        yield f"image_{name}", gltf(changed(inside, {"uri": uri}))
    for member, values in {"/images/0/bufferView": (-1, 99, 0), "/textures/0/source": (-1, 7), "/textures/0/sampler": (-1, 7),
                           "/materials/0/pbrMetallicRoughness/baseColorTexture/index": (-1, 7, 2**40),
                           "/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord": (-1, 7, 2**31),
                           "/materials/0/alphaMode": ("", "SOME"), "/materials/0/alphaCutoff": (-1, 1e300),
                           "/samplers/0/wrapS": (0, -1)}.items():
        for value in values:
            yield f"{member.strip('/').replace('/', '_')}_{value or 'empty'}", gltf(changed(member, value))
    for name, factor in {"negative": [-1, -1, -1, -1], "huge": [1e38] * 4, "double": [1e300] * 4, "short": [1], "long": [1] * 9}.items():
        yield f"base_color_{name}", gltf(changed("/materials/0/pbrMetallicRoughness/baseColorFactor", factor))
        yield f"emissive_{name}", gltf(changed("/materials/1/emissiveFactor", factor[:3]))
    for strength in (-1, 0, 1e38, 1e300):
        yield f"emissive_strength_{strength:g}", gltf(changed(
            "/materials/1/extensions/KHR_materials_emissive_strength/emissiveStrength", strength))


def extension_cases():
    garbage = (None, 7, "x", [], {}, {"bufferView": 99}, {"attributes": {"POSITION": -1}}, {"count": 2**40})
    places = {"KHR_draco_mesh_compression": "/meshes/0/primitives/0", "EXT_meshopt_compression": "/bufferViews/0",
              "KHR_mesh_quantization": "", "EXT_mesh_gpu_instancing": "/nodes/1", "KHR_lights_punctual": "",
              "KHR_texture_transform": "/materials/0/pbrMetallicRoughness/baseColorTexture",
              "KHR_materials_pbrSpecularGlossiness": "/materials/0", "KHR_materials_unlit": "/materials/0"}
    for name, place in places.items():
        for k, value in enumerate(garbage):
            yield f"{name}_{k}", gltf(changed(f"{place}/extensions", {name: value}))
        yield f"{name}_required", gltf(changed("/extensionsRequired", [name]))
    yield "meshopt_4_gb", gltf(changed("/bufferViews/0/extensions", {"EXT_meshopt_compression": {
        "buffer": 0, "byteLength": 48, "byteStride": 12, "count": 2**32 - 1, "mode": "ATTRIBUTES"}},
        "/extensionsRequired", ["EXT_meshopt_compression"]))
    for member, values in {"type": ("sun", "", "spot"), "intensity": (-1, 1e300), "color": ([], [-1, 0, 0], [1e38] * 3),
                           "range": (-1, 0), "spot": (7, {"outerConeAngle": 9}, {"innerConeAngle": 1, "outerConeAngle": 0.5})}.items():
        for k, value in enumerate(values):
            yield f"light_{member}_{k}", gltf(changed(f"/extensions/KHR_lights_punctual/lights/0/{member}", value))
    for value in (-1, 7, 2**33):
        yield f"light_index_{value}", gltf(changed("/nodes/4/extensions/KHR_lights_punctual/light", value))
    for k, value in enumerate(({"offset": [1e300, 0]}, {"scale": [0, 0]}, {"scale": [1e38, 1e38]}, {"rotation": 1e300},
                               {"offset": [1]}, {"texCoord": -1}, {"texCoord": 99}, {"scale": "large"})):
        yield f"transform_{k}", gltf(changed(
            "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform", value))


def container_cases():
    sound = glb(sound_document())
    for length in (0, 1, 3, 4, 11, 12, 19, 20, 21, 100, len(sound) - 1, len(sound) - 200):
        yield f"cut_at_{length}", sound[:length]
    for name, lengths in {"json_0": {"json": 0}, "json_4_gb": {"json": 2**32 - 1}, "json_odd": {"json": 5},
                          "bin_4_gb": {"bin": 2**32 - 8}, "bin_0": {"bin": 0}, "bin_more": {"bin": 8 + len(BINARY)},
                          "total_0": {"total": 0}, "total_4_gb": {"total": 2**32 - 1}, "total_less": {"total": 500}}.items():
        yield f"length_{name}", glb(sound_document(), **lengths)
    yield "version_1", sound[:4] + struct.pack("<I", 1) + sound[8:]
    yield "version_9", sound[:4] + struct.pack("<I", 9) + sound[8:]
    yield "chunks_swapped", sound[:12] + chunk(b"BIN\0", b"1234") + sound[12:]
    yield "json_twice", sound[:12] + chunk(b"JSON", b"{}  ") + sound[12:]
    yield "json_empty_object", glb({})
    yield "json_list", glb([])
    yield "json_garbage", glb(b"\0\1\2\3" * 20)


def text_cases():
    sound = gltf(sound_document())
    yield "bad_utf8_name", sound.replace(b"wood", b"w\xff\xfeod")
    yield "bad_utf8_key", sound.replace(b'"scenes"', b'"sc\xc3\x28nes"')
    yield "lone_surrogate", sound.replace(b"wood", rb"\ud800")
    yield "nul_in_name", sound.replace(b"wood", rb"wo\u0000od")
    yield "control_characters", sound.replace(b"wood", rb"\u001b[31mred\u0007\n\n")
    yield "byte_order_mark", b"\xef\xbb\xbf" + sound
    yield "utf16", sound.decode().encode("utf-16")
    yield "duplicate_keys", sound[:-1] + b', "meshes": [], "scene": 7}'
    yield "two_documents", sound + sound
    yield "trailing_comma", sound[:-1] + b",}"
    yield "comment", b"/* scene */" + sound
    yield "cut_text", sound[:len(sound) // 2]
    for name, brackets in {"lists": b"[" * 100_000, "objects": b'{"a":' * 100_000}.items():
        yield f"nested_{name}", sound[:-1] + b', "extras": ' + brackets
        yield f"only_{name}", brackets
    yield "closed_lists", sound[:-1] + b', "extras": ' + b"[" * 100_000 + b"]" * 100_000 + b"}"
    yield "long_name", sound.replace(b"wood", b"w" * 1_000_000)
    yield "many_materials", gltf(changed("/materials", [{"name": "m"}] * 50_000))
    for version in ("1.0", "3.0", "", "2", "two", "2.0.0", "-2.0"):
        yield f"version_text_{version or 'empty'}", gltf(changed("/asset/version", version))


def named_cases():
    """Those with a reason of their own, in groups; .glb where the content is a container."""
    for group in (coordinate_cases, accessor_cases, sparse_cases, node_cases, multiplied_cases, image_cases, extension_cases,
                  container_cases, text_cases):
        for name, content in group():
            is_binary = content[:4] == b"glTF" or group is container_cases
            yield Case(f"{name}.{'glb' if is_binary else 'gltf'}", content)


# ---- Cases by chance

WRONG_VALUES = (None, True, -1, 0, 0.5, 1e308, -1e30, 2**31, 2**32, 2**63, 2**64, "", "x", [], [[]], {}, [-1], {"x": 1},
                [None], [1e39] * 16)


def members(value, path=()):
    """The paths of all members and elements of a document."""
    entries = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, child in entries:
        yield path + (key,)
        yield from members(child, path + (key,))


def wrong_member(random_, number):
    document = sound_document()
    paths = list(members(document))
    *way, last = random_.choice(paths)
    place = document
    for part in way:
        place = place[part]
    place[last] = random_.choice(WRONG_VALUES)
    binary = random_.random() < 0.5
    label = "_".join(map(str, (*way, last)))
    return Case(f"wrong_{number}_{label}.{'glb' if binary else 'gltf'}", (glb if binary else gltf)(document))


def cases(count, seed):
    """The sound scenes and `count` cases: the named ones, as many as fit, then a half each by wrong members and flipped bytes."""
    sound = {"glb": glb(sound_document()), "gltf": gltf(sound_document())}
    for kind, content in sound.items():
        yield Case(f"{SOUND_NAME}.{kind}", content)
    random_ = random.Random(seed)
    named = list(named_cases())
    if len(named) > count * 2 // 3:
        named = random_.sample(named, count * 2 // 3)
    yield from named
    for number in range(count - len(named)):
        if number % 2 == 0:
            yield wrong_member(random_, number)
        else:
            kind = random_.choice(sorted(sound))
            yield Case(f"flipped_{number}.{kind}", flipped(random_, sound[kind]))


if __name__ == "__main__":
    sys.exit(main(__doc__, 600, cases))
