"""Writes a scene of data/generate.py as PLY and as STL, which have no materials.

PLY keeps the faces and, as colours of the faces, the reflectances; STL keeps triangles and the names of the objects.
"""
import struct

from scene_files import number, placed


def world_faces(scene):
    """For each node its name and its faces (material, corners) in the scene."""
    return [(node.name, [(material, [placed(node, p) for p in points])
                         for part in scene.meshes[node.mesh] for material, points in part]) for node in scene.nodes]


def write_ply(scene, folder, byte_order=None):
    """`byte_order`: "<" or ">" for a binary file. Scenes of one material have no colours."""
    index, faces = {}, []
    for k, (_, node_faces) in enumerate(world_faces(scene)):
        for material, points in node_faces:  # objects share no vertices
            faces.append((material, [index.setdefault((k, p), len(index)) for p in points]))
    coloured = len(scene.materials) > 1
    header = ["ply", f"format { {None: 'ascii', '<': 'binary_little_endian', '>': 'binary_big_endian'}[byte_order]} 1.0",
              *(f"comment {line}" for line in scene.comment), "comment A PLY file holds no emission: --emit default=r,g,b",
              f"element vertex {len(index)}", *(f"property double {axis}" for axis in "xyz"),
              f"element face {len(faces)}", "property list uchar int vertex_indices",
              *(f"property float {channel}" for channel in ("red", "green", "blue") if coloured), "end_header"]
    colours = [scene.materials[material].kd if coloured else () for material, _ in faces]
    path = folder / f"{scene.name}.ply"
    if byte_order is None:
        lines = [" ".join(map(number, p)) for _, p in index]
        lines += [" ".join([str(len(corners)), *map(str, corners), *map(number, colour)])
                  for (_, corners), colour in zip(faces, colours)]
        path.write_text("\n".join(header + lines) + "\n")
    else:
        body = b"".join(struct.pack(byte_order + "3d", *p) for _, p in index)
        body += b"".join(struct.pack(f"{byte_order}B{len(corners)}i{len(colour)}f", len(corners), *corners, *colour)
                         for (_, corners), colour in zip(faces, colours))
        path.write_bytes("\n".join(header).encode() + b"\n" + body)


def normal_of(a, b, c):
    u, v = ([q - p for p, q in zip(a, other)] for other in (b, c))
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    length = sum(x * x for x in n) ** .5
    return tuple(x / length + 0.0 for x in n)


def write_stl(scene, folder, binary=False):
    """Triangles fanned from a face's first corner; in text each object is a solid."""
    solids = [(name, [(points[0], a, b) for _, points in faces for a, b in zip(points[1:], points[2:])])
              for name, faces in world_faces(scene)]
    path = folder / f"{scene.name}.stl"
    if binary:
        facets = [triangle for _, triangles in solids for triangle in triangles]
        body = b"".join(struct.pack("<12fH", *normal_of(*t), *(x for p in t for x in p), 0) for t in facets)
        path.write_bytes(scene.name.encode().ljust(80, b"\0") + struct.pack("<I", len(facets)) + body)
        return
    lines = []
    for name, triangles in solids:
        lines.append(f"solid {name}")
        for triangle in triangles:
            lines += ["facet normal " + " ".join(f"{x:.6g}" for x in normal_of(*triangle)), "outer loop",
                      *("vertex " + " ".join(map(number, p)) for p in triangle), "endloop", "endfacet"]
        lines.append(f"endsolid {name}")
    path.write_text("\n".join(lines) + "\n")
