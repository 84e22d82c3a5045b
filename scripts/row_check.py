"""Rows of a scene's form factors against rays that share nothing with them but the scene and its patches.

RAYS cosine-distributed independent rays of each row start from POINTS random points of its patch. By the first half of the points, of
which G_j is the share of rays that meets patch j, columns are put into bins of LEAST rays or more, each with a weight w = (F + G) / 2 and
a sign s, that of G - F, or 0 if it is less than twice the noise. By the second half, with shares H whose variance is v:

    least = sum s (H - F)                   is at most the error of the row, sum_j |error of F_j|
    most2 = sum ((H - F)^2 - v) / w         is at least the square of it (over bins), since the w sum to 1

in the mean, whatever the noise of the rays. The first is sharp if few columns make up the error, the second if all err by the same share.
"""
import array
import json
import math
import random
import struct
import tempfile
from pathlib import Path

import scene_bakes
from scene_bakes import mesh_options

RAYS, POINTS, LEAST = 100000, 1000, 5
ROWS_AT_ONCE = 10
COVERED = 0.8  # of what patches see: they lie inside or beneath something
SPARSE = 20000  # patches above which a matrix is three files


class Patches:
    """Of a solution file, as far as points on them need it."""

    def __init__(self, path):
        data = Path(path).read_bytes()
        size, = struct.unpack_from("<I", data, 12)
        document, start = json.loads(data[20:20 + size]), 28 + size
        facts = document["extras"]["lambert"]

        def numbers(name, kind, width):
            accessor = document["accessors"][facts[name]]
            begin = start + document["bufferViews"][accessor["bufferView"]]["byteOffset"]
            return array.array(kind, data[begin:begin + 4 * width * accessor["count"]])

        self.positions, self.corners = numbers("positions", "f", 3), numbers("corners", "I", 4)
        self.origin, self.count = facts.get("origin", [0, 0, 0]), facts["patches"]
        self.opacity = numbers("opacity", "f", 1) if "opacity" in facts else None
        self.area = numbers("area", "f", 1)

    def usable(self, patch):
        """Whether points all over its outline are points of it."""
        return self.area[patch] > 0 and (self.opacity is None or self.opacity[patch] > .9999)

    def points(self, patch, count, chance):
        """Uniformly distributed, as lines x,y,z,nx,ny,nz. Quads are divided by the diagonal from their first corner."""
        corners = [self.positions[3 * v:3 * v + 3] for v in self.corners[4 * patch:4 * patch + 4] if v != 0xFFFFFFFF]
        triangles = [(corners[0], corners[k], corners[k + 1]) for k in range(1, len(corners) - 1)]
        normals = [cross(difference(b, a), difference(c, a)) for a, b, c in triangles]
        normal = [sum(n[k] for n in normals) for k in range(3)]
        chosen = chance.choices(triangles, [math.hypot(*n) for n in normals], k=count)
        lines = []
        for a, b, c in chosen:
            u, v = chance.random(), chance.random()
            if u + v > 1:
                u, v = 1 - u, 1 - v
            place = [o + p + u * (q - p) + v * (r - p) for o, p, q, r in zip(self.origin, a, b, c)]
            lines.append(",".join(f"{x:.9g}" for x in [*place, *normal]))
        return lines


def difference(a, b):
    """a - b."""
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    """a x b."""
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def npy(path, kind, begin, count):
    """`count` numbers from the `begin`th of an array file."""
    with open(path, "rb") as file:
        head = file.read(12)
        size, = struct.unpack_from("<I" if head[6] > 1 else "<H", head, 8)
        result = array.array(kind)
        file.seek((12 if head[6] > 1 else 10) + size + begin * result.itemsize)
        result.frombytes(file.read(count * result.itemsize))
    return result


def matrix_row(path, row, patches):
    """The factors of one row of NAME.npy."""
    path = Path(path)
    if patches <= SPARSE:
        return npy(path, "d", row * patches, patches)
    begin, end = npy(path.with_suffix(".indptr.npy"), "q", row, 2)
    factors = [0.0] * patches
    for column, factor in zip(npy(path.with_suffix(".indices.npy"), "q", begin, end - begin),
                              npy(path.with_suffix(".data.npy"), "d", begin, end - begin)):
        factors[column] = factor
    return factors


def remainders(path):
    """F_back and F_out of every row: the last two numbers of a line."""
    with open(path, encoding="utf-8") as file:
        return [tuple(float(x) for x in line.split(",")[-2:]) for line in file if line[0] != "#"]


def mtx_rows(path):
    """Yields row and list of (column, value) of a Matrix Market file that is sorted by rows; both from 0."""
    row, entries = None, []
    with open(path, encoding="utf-8") as file:
        lines = (line.split() for line in file if line[0] != "%")
        next(lines)  # sizes
        for i, j, value in lines:
            if i != row:
                if row is not None:
                    yield int(row) - 1, entries
                row, entries = i, []
            entries.append((int(j) - 1, float(value)))
    if row is not None:
        yield int(row) - 1, entries


class Row:
    """A row's `factors`, with the remainders last, and what the rays of its points, `rays` each, have found of them so far."""

    def __init__(self, factors, points, rays):
        self.factors, self.learning, self.rays, self.points = factors, points // 2, rays, 0
        self.shares = [0.0] * len(factors)  # of the first half
        self.bin_of = self.sum = self.squares = None

    def add(self, shares):
        """Of one point: list of (column, share)."""
        if self.points < self.learning:
            for column, share in shares:
                self.shares[column] += share / self.learning
        else:
            if self.bin_of is None:
                self.make_bins()
            found = {}
            for column, share in shares:
                found[self.bin_of[column]] = found.get(self.bin_of[column], 0.0) + share
            for k, share in found.items():
                self.sum[k] += share
                self.squares[k] += share * share
        self.points += 1

    def make_bins(self):
        """Columns of enough rays have their own, the others share one until it is full."""
        self.bin_of, self.expected, self.weights = [], [], []
        enough, pool = LEAST / (self.learning * self.rays), None
        for factor, share in zip(self.factors, self.shares):
            weight = (factor + share) / 2
            into = pool if weight < enough and pool is not None else len(self.weights)
            if into == len(self.weights):
                self.expected.append(0.0)
                self.weights.append(0.0)
            self.bin_of.append(into)
            self.expected[into] += factor
            self.weights[into] += weight
            if weight < enough:
                pool = into if self.weights[into] < enough else None
        self.weights = [max(weight, enough) for weight in self.weights]
        self.sum, self.squares = [0.0] * len(self.weights), [0.0] * len(self.weights)

    def bounds(self):
        """least and most2."""
        least = most2 = 0.0
        points = self.points - self.learning
        for factor, weight, total, squares in zip(self.expected, self.weights, self.sum, self.squares):
            share = total / points
            most2 += ((share - factor) ** 2 - (squares / points - share * share) / (points - 1)) / weight
            first = 2 * (weight - factor / 2)
            if abs(first - factor) > 2 * math.sqrt(weight / (self.learning * self.rays)):
                least += math.copysign(share - factor, (first - factor) * (share - factor))
        return least, most2


class RowCheck:
    """The default factors of a scene: `report` of `lambert formfactors`, `repair`, its report of it, and `bounds` of random rows."""

    def __init__(self, bakes, scene, options, rows, seed=1):
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            matrix, solution = folder / "matrix.npy", folder / "patches.glb"
            bakes.run("bake", scene, "--solver", "random-walk", "--rays", 1000, *mesh_options(options), "--solution", solution)
            self.report = bakes.run("formfactors", scene, *options, "-o", matrix)
            self.repair = self.report["repair"] or repaired(bakes, scene, options, matrix)
            patches, rest = Patches(solution), remainders(f"{matrix}.areas.csv")
            chosen = [i for i in range(patches.count) if patches.usable(i) and rest[i][0] <= COVERED]
            chance = random.Random(seed)
            chosen = sorted(chance.sample(chosen, min(rows, len(chosen))))
            self.bounds = []
            for begin in range(0, len(chosen), ROWS_AT_ONCE):
                some = chosen[begin:begin + ROWS_AT_ONCE]
                found = [Row([*matrix_row(matrix, i, patches.count), *rest[i]], POINTS, RAYS // POINTS) for i in some]
                places = [line for i in some for line in patches.points(i, POINTS, chance)]
                for k, shares in enumerate(traced(bakes, scene, mesh_options(options), places, folder, 1000 * seed + begin)):
                    found[k // POINTS].add(shares)
                self.bounds += [row.bounds() for row in found]

    def error(self):
        """Of rows in the mean: least, the standard error of that, and most."""
        count = len(self.bounds)
        least = sum(bound for bound, _ in self.bounds) / count
        spread = sum((bound - least) ** 2 for bound, _ in self.bounds) / max(1, count - 1) / count
        return least, math.sqrt(spread), math.sqrt(max(0.0, sum(square for _, square in self.bounds) / count))


def repaired(bakes, scene, options, matrix):
    """The report of a repair of the matrix; None if it is too large for one."""
    try:
        return bakes.run("formfactors", scene, *mesh_options(options), "--form-factors", matrix, "--repair")["repair"]
    except scene_bakes.NoReport as error:
        if error.code != scene_bakes.SYSTEM:
            raise
        return None


def traced(bakes, scene, mesh, places, folder, seed):
    """Of every point the list of (column, share) of its rays; the last two columns are F_back and F_out."""
    (folder / "points.csv").write_text("\n".join(places) + "\n", encoding="utf-8")
    shares = folder / "shares.mtx"
    report = bakes.run("formfactors", scene, *mesh, "--points", folder / "points.csv", "-o", shares, "--method", "local-lines",
                       "--sampler", "random", "--lines", RAYS // POINTS, "--storage", "double", "--seed", seed)
    ends = [[(report["patches"] + k, share) for k, share in enumerate(pair) if share > 0]
            for pair in remainders(f"{shares}.points.csv")]
    for k, entries in mtx_rows(shares):  # rows may be missing: all rays left
        ends[k] = entries + ends[k]
    return ends
