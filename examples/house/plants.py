#!/usr/bin/env python3
"""Grows tree.glb, hedge.glb and lawn.glb, the plants of house.heliodon.json, beside this file: the same bytes each time.

Metres, +Y up. Leaves are flat rhombi in the colours of their vertices (linear albedo); a hedge has a closed dark core.
"""
import json
import math
import random
import struct
from pathlib import Path

BYTE, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT = 5120, 5121, 5122, 5123  # as glTF numbers them
VERTICES, ELEMENTS = 34962, 34963


class Mesh:
    def __init__(self):
        self.positions, self.colors, self.indices = [], [], []

    def vertex(self, position, color):
        self.positions.append(position)
        self.colors.append(color)
        return len(self.positions) - 1

    def quad(self, corners, color):
        a, b, c, d = (self.vertex(corner, color) for corner in corners)
        self.indices += [a, b, c, a, c, d]

    def leaf(self, middle, normal, length, color, rng):
        """A rhombus with its long axis anywhere in its plane."""
        along = unit(cross(normal, direction(rng)))
        across = scaled(cross(normal, along), 0.28 * length)
        along = scaled(along, 0.5 * length)
        self.quad([plus(middle, along, -1), plus(middle, across, -1), plus(middle, along), plus(middle, across)], color)

    def box(self, low, high, color):
        corner = lambda i: tuple(high[k] if i >> k & 1 else low[k] for k in range(3))
        for face in ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)):
            self.quad([corner(i) for i in face], color)

    def limb(self, start, end, radius_start, radius_end, color, sides=7):
        axis = unit(plus(end, start, -1))
        u = unit(cross(axis, (0.3, 0.1, 0.95)))
        v = cross(axis, u)
        rings = []
        for middle, radius in ((start, radius_start), (end, radius_end)):
            turns = [2 * math.pi * i / sides for i in range(sides)]
            rings.append([self.vertex(plus(plus(middle, u, radius * math.cos(t)), v, radius * math.sin(t)), color) for t in turns])
        for i in range(sides):
            a, b = rings[0][i], rings[0][(i + 1) % sides]
            c, d = rings[1][(i + 1) % sides], rings[1][i]
            self.indices += [a, b, c, a, c, d]
        for i in range(1, sides - 1):
            self.indices += [rings[0][0], rings[0][i + 1], rings[0][i], rings[1][0], rings[1][i], rings[1][i + 1]]


def plus(a, b, times=1.0):
    return tuple(x + times * y for x, y in zip(a, b))


def scaled(a, times):
    return tuple(times * x for x in a)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return scaled(a, 1 / math.sqrt(sum(x * x for x in a)))


def direction(rng):
    """Evenly over the sphere."""
    z, turn = rng.uniform(-1, 1), rng.uniform(0, 2 * math.pi)
    flat = math.sqrt(1 - z * z)
    return (flat * math.cos(turn), z, flat * math.sin(turn))


def shade_of(color, rng, spread=0.3):
    return scaled(color, 1 + rng.uniform(-spread, spread))


def grow_tree(rng, bark=(0.16, 0.12, 0.085), green=(0.075, 0.14, 0.03)):
    """A broad-leaved tree 6.5 m high with a crown 5 m wide."""
    wood, leaves = Mesh(), Mesh()

    def branch(start, heading, length, radius, order):
        bend = unit(plus(heading, direction(rng), 0.18))
        end = plus(start, bend, length)
        wood.limb(start, end, radius, 0.7 * radius, bark, 9 - order)
        if order >= 2:
            for _ in range(14 if order == 2 else 32):
                at = plus(plus(start, bend, length * rng.uniform(0.3, 1.1)), direction(rng), rng.uniform(0.05, 0.42))
                leaves.leaf(at, unit(plus(direction(rng), (0, 0.5, 0))), rng.uniform(0.15, 0.24), shade_of(green, rng), rng)
        if order == 4:
            return
        for i in range(4 if order == 0 else 3):
            turn = 2.4 * i + rng.uniform(0, 0.9) + order
            side = unit(plus(cross(bend, (math.cos(turn), 0.2, math.sin(turn))), bend, rng.uniform(0.55, 1.1)))
            side = unit(plus(side, (0, 0.22, 0)))
            branch(plus(start, bend, length * rng.uniform(0.72, 1)), side, length * rng.uniform(0.6, 0.78), 0.6 * radius, order + 1)

    branch((0, -0.1, 0), (0, 1, 0), 2.0, 0.13, 0)
    return wood, leaves


def grow_hedge(rng, green=(0.05, 0.1, 0.025)):
    """4 m along x, 0.8 m deep, 1.9 m high, from y = 0."""
    core, leaves = Mesh(), Mesh()
    core.box((0, 0, -0.32), (4, 1.8, 0.32), scaled(green, 0.4))
    for _ in range(1500):
        if rng.random() < 0.2:
            at, out = (rng.uniform(0, 4), 1.8, rng.uniform(-0.34, 0.34)), (0, 1, 0)
        else:
            side = rng.choice((-1, 1))
            at, out = (rng.uniform(0, 4), rng.uniform(0.02, 1.8), 0.32 * side), (0, 0, side)
        at = plus(at, out, rng.uniform(0.01, 0.12))
        leaves.leaf(at, unit(plus(direction(rng), out, 1.2)), rng.uniform(0.1, 0.17), shade_of(green, rng), rng)
    return core, leaves


def grow_lawn(rng, green=(0.075, 0.125, 0.035), cells=56, size_m=28):
    """A square about the origin, uneven in colour; its height varies by 2 cm."""
    lawn = Mesh()
    waves = [(rng.uniform(0.15, 2.2), rng.uniform(0, 2 * math.pi), rng.uniform(0, 2 * math.pi)) for _ in range(14)]
    for j in range(cells + 1):
        for i in range(cells + 1):
            x, z = (size_m * (k / cells - 0.5) for k in (i, j))
            wave = sum(math.sin(f * (x * math.cos(t) + z * math.sin(t)) + p) for f, t, p in waves) / math.sqrt(len(waves))
            shade = shade_of(green, rng, 0.12)
            dry = max(0.0, 0.5 + 0.35 * wave)
            lawn.vertex((x, -0.02 + 0.01 * wave, z), plus(shade, (0.03, 0.012, 0.004), dry))
    row = cells + 1
    for j in range(cells):
        for i in range(cells):
            a = j * row + i
            lawn.indices += [a, a + row, a + row + 1, a, a + row + 1, a + 1]
    return (lawn,)


def normals_of(mesh):
    """Of each vertex: the mean of its triangles' by area."""
    normals = [(0.0, 0.0, 0.0)] * len(mesh.positions)
    for i in range(0, len(mesh.indices), 3):
        corners = mesh.indices[i : i + 3]
        a, b, c = (mesh.positions[corner] for corner in corners)
        face = cross(plus(b, a, -1), plus(c, a, -1))
        for corner in corners:
            normals[corner] = plus(normals[corner], face)
    return [unit(n) for n in normals]


def glb(meshes):
    """glTF of one node, a primitive a mesh, that shows both sides; positions are of 16 bits, normals and colours of 8."""
    blob, views, accessors, primitives = b"", [], [], []
    reach_m = max(abs(x) for mesh in meshes for p in mesh.positions for x in p)

    def add(data, target, **accessor):
        nonlocal blob
        stride = {} if target == ELEMENTS else {"byteStride": len(data) // accessor["count"]}
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": len(data), "target": target, **stride})
        accessors.append({"bufferView": len(views) - 1, **accessor})
        blob += data + b"\0" * (-len(data) % 4)
        return len(accessors) - 1

    for mesh in meshes:
        count = len(mesh.positions)
        shorts = [[round(32767 * x / reach_m) for x in p] for p in mesh.positions]
        low, high = ([pick(p[k] for p in shorts) for k in range(3)] for pick in (min, max))
        positions = add(b"".join(struct.pack("<4h", *p, 0) for p in shorts), VERTICES, componentType=SHORT, count=count,
                        type="VEC3", normalized=True, min=low, max=high)
        packed = b"".join(struct.pack("<4b", *(round(127 * x) for x in n), 0) for n in normals_of(mesh))
        normals = add(packed, VERTICES, componentType=BYTE, count=count, type="VEC3", normalized=True)
        shades = bytes(x for c in mesh.colors for x in (*(min(255, round(255 * v)) for v in c), 255))
        colors = add(shades, VERTICES, componentType=UNSIGNED_BYTE, count=count, type="VEC4", normalized=True)
        indices = add(struct.pack(f"<{len(mesh.indices)}H", *mesh.indices), ELEMENTS, componentType=UNSIGNED_SHORT,
                      count=len(mesh.indices), type="SCALAR")
        primitives.append({"attributes": {"POSITION": positions, "NORMAL": normals, "COLOR_0": colors}, "indices": indices,
                           "material": 0})
    quantized = ["KHR_mesh_quantization"]
    head = {"asset": {"version": "2.0", "generator": "plants.py"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "extensionsUsed": quantized, "extensionsRequired": quantized,
            "nodes": [{"mesh": 0, "scale": [reach_m] * 3}], "meshes": [{"primitives": primitives}],
            "materials": [{"name": "plant", "doubleSided": True, "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.8}}],
            "buffers": [{"byteLength": len(blob)}], "bufferViews": views, "accessors": accessors}
    text = json.dumps(head, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(blob), 0x004E4942) + blob
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


if __name__ == "__main__":
    for name, grow in (("tree", grow_tree), ("hedge", grow_hedge), ("lawn", grow_lawn)):
        Path(__file__).with_name(f"{name}.glb").write_bytes(glb(grow(random.Random(name))))
