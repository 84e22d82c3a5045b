"""A small glTF scene with most of what the format can say, and how to pack it, also wrongly: what mutate_gltf.py starts from."""
import base64
import json
import struct
import zlib


def png(width, height, rgb=b"\xc0\x80\x40"):
    """An RGB image of one colour."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) +
            chunk(b"IDAT", zlib.compress((b"\0" + rgb * width) * height)) + chunk(b"IEND", b""))


def floats(*values):
    return struct.pack(f"<{len(values)}f", *values)


# A unit square in four vertices: positions (48 bytes), texture coordinates (32), indices (12), an image.
POSITIONS = floats(0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0)
COORDINATES = floats(0, 0, 1, 0, 1, 1, 0, 1)
INDICES = struct.pack("<6H", 0, 1, 2, 0, 2, 3)
IMAGE = png(2, 2)
BINARY = POSITIONS + COORDINATES + INDICES + IMAGE


def sound_document():
    """A lamp over a textured floor, with a camera and a light; its buffer is BINARY."""
    return {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_lights_punctual", "KHR_texture_transform", "KHR_materials_emissive_strength"],
        "extensions": {"KHR_lights_punctual": {"lights": [
            {"type": "spot", "color": [1, 0.5, 0.25], "intensity": 10, "range": 5,
             "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.5}}]}},
        "scene": 0,
        "scenes": [{"name": "room", "nodes": [0]}],
        "nodes": [
            {"name": "root", "children": [1, 2, 3, 4], "scale": [2, 2, 2]},
            {"name": "floor", "mesh": 0},
            {"name": "lamp", "mesh": 1, "rotation": [1, 0, 0, 0], "translation": [0, 1, 1]},
            {"name": "eye", "camera": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 3, 1]},
            {"name": "spot", "translation": [0, 0, 2], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "aspectRatio": 1.5, "znear": 0.01}}],
        "meshes": [
            {"name": "floor", "primitives": [
                {"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0, "mode": 4}]},
            {"name": "lamp", "primitives": [{"attributes": {"POSITION": 0}, "indices": 2, "material": 1}]}],
        "materials": [
            {"name": "wood", "alphaMode": "MASK", "alphaCutoff": 0.5, "pbrMetallicRoughness": {
                "baseColorFactor": [0.9, 0.8, 0.7, 1], "metallicFactor": 0, "roughnessFactor": 1, "baseColorTexture": {
                    "index": 0, "texCoord": 0,
                    "extensions": {"KHR_texture_transform": {"offset": [0.1, 0.2], "rotation": 0.3, "scale": [2, 2]}}}}},
            {"name": "light", "doubleSided": True, "emissiveFactor": [1, 1, 1],
             "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 5}}}],
        "textures": [{"source": 0, "sampler": 0}],
        "samplers": [{"wrapS": 10497, "wrapT": 33071}],
        "images": [{"bufferView": 3, "mimeType": "image/png"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
            {"bufferView": 2, "byteOffset": 0, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 48, "byteStride": 12, "target": 34962},
            {"buffer": 0, "byteOffset": 48, "byteLength": 32},
            {"buffer": 0, "byteOffset": 80, "byteLength": 12, "target": 34963},
            {"buffer": 0, "byteOffset": 92, "byteLength": len(IMAGE)}],
        "buffers": [{"byteLength": len(BINARY)}]}


def data_uri(binary):
    return "data:application/octet-stream;base64," + base64.b64encode(binary).decode()


def gltf(document, binary=BINARY):
    """A .gltf with its buffer inside, unless the document says where it is."""
    buffers = document.get("buffers")
    if isinstance(buffers, list) and buffers and isinstance(buffers[0], dict) and "uri" not in buffers[0]:
        document = {**document, "buffers": [{**buffers[0], "uri": data_uri(binary)}, *buffers[1:]]}
    return json.dumps(document).encode()


def chunk(kind, content, length=None):
    return struct.pack("<I4s", len(content) if length is None else length, kind) + content


def glb(document, binary=BINARY, **lengths):
    """A .glb; `lengths` are the wrong ones: json, bin, total."""
    text = document if isinstance(document, bytes) else json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = chunk(b"JSON", text, lengths.get("json")) + chunk(b"BIN\0", binary, lengths.get("bin"))
    return struct.pack("<4sII", b"glTF", 2, lengths.get("total", 12 + len(chunks))) + chunks
