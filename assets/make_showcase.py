#!/usr/bin/env python3
"""Writes assets/showcase.gltf: glass and mirror spheres over a checkered floor, after Whitted (1980)."""
import base64, json, math, os, struct, zlib


def data_uri(mime, data):
    return f"data:{mime};base64,{base64.b64encode(data).decode()}"


def png(width, height, rows):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    raw = b"".join(b"\0" + bytes(v for pixel in row for v in pixel) for row in rows)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def phong(name, **parameters):
    return {"name": name, "extensions": {"ALHAZEN_materials_phong": parameters}}


def sphere(name, shape, at, material):
    return {"name": name, "translation": at, "extensions": {"ALHAZEN_shapes": {"shape": shape, "material": material}}}


def torus(major, minor, rings, sides):
    """Positions, normals and triangles of a torus about the y axis; shared vertices."""
    positions, normals, triangles = [], [], []
    for i in range(rings):
        a = 2 * math.pi * i / rings
        for j in range(sides):
            b = 2 * math.pi * j / sides
            n = (math.cos(a) * math.cos(b), math.sin(b), math.sin(a) * math.cos(b))
            normals.append(n)
            positions.append((math.cos(a) * major + n[0] * minor, n[1] * minor, math.sin(a) * major + n[2] * minor))
            p, q = i * sides, (i + 1) % rings * sides
            k = (j + 1) % sides
            triangles += [(p + j, p + k, q + j), (p + k, q + k, q + j)]
    return positions, normals, triangles


tiles = [[((214, 74, 50) if (x + y) % 2 else (240, 206, 96)) for x in range(16)] for y in range(16)]
floor_p = [(-12, 0, 12), (12, 0, 12), (12, 0, -12), (-12, 0, -12)]
floor_uv = [(0, 1), (1, 1), (1, 0), (0, 0)]
ring_p, ring_n, ring_t = torus(0.62, 0.2, 96, 48)

blob, views, accessors = b"", [], []


def accessor(rows, component, kind, code):
    global blob
    data = b"".join(struct.pack("<" + code * len(row), *row) for row in rows)
    views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": len(data)})
    blob += data
    count = len(rows) * len(rows[0]) if kind == "SCALAR" else len(rows)
    entry = {"bufferView": len(views) - 1, "componentType": component, "count": count, "type": kind}
    if kind == "VEC3":
        as_float = [[struct.unpack("<f", struct.pack("<f", v))[0] for v in row] for row in rows]
        entry["min"] = [min(c) for c in zip(*as_float)]
        entry["max"] = [max(c) for c in zip(*as_float)]
    accessors.append(entry)
    return len(accessors) - 1


floor = {"attributes": {"POSITION": accessor(floor_p, 5126, "VEC3", "f"),
                        "TEXCOORD_0": accessor(floor_uv, 5126, "VEC2", "f")},
         "indices": accessor([(0, 1, 2), (0, 2, 3)], 5125, "SCALAR", "I"), "material": 0}
ring = {"attributes": {"POSITION": accessor(ring_p, 5126, "VEC3", "f"), "NORMAL": accessor(ring_n, 5126, "VEC3", "f")},
        "indices": accessor(ring_t, 5125, "SCALAR", "I"), "material": 3}

pitch = math.radians(-12)
scene = {
    "asset": {"version": "2.0", "generator": "assets/make_showcase.py"},
    "extensionsUsed": ["ALHAZEN_lights", "ALHAZEN_materials_phong", "ALHAZEN_shapes", "KHR_lights_punctual", "KHR_texture_transform"],
    "scene": 0,
    "scenes": [{"nodes": [0, 1, 2, 3, 4, 5, 6, 7], "extensions": {"ALHAZEN_lights": {"ambient": [0.34, 0.35, 0.38], "background": [0.26, 0.42, 0.66]}}}],
    "nodes": [
        {"name": "floor", "mesh": 0},
        sphere("glass", 0, [-0.55, 1.25, 1.1], 1),
        sphere("mirror", 0, [1.0, 1.05, -0.7], 2),
        {"name": "ring", "mesh": 1, "translation": [1.5, 0.2, 1.5]},
        sphere("pearl", 1, [-2.1, 0.42, -0.6], 4),
        {"name": "camera", "camera": 0, "translation": [0.1, 2.5, 7.2], "rotation": [math.sin(pitch / 2), 0, 0, math.cos(pitch / 2)]},
        {"name": "lamp", "translation": [-3.5, 6.5, 4.5], "extensions": {"KHR_lights_punctual": {"light": 0}}},
        {"name": "sky", "rotation": [-0.45, 0.32, 0.17, 0.82], "extensions": {"KHR_lights_punctual": {"light": 1}}},
    ],
    "cameras": [{"name": "front", "type": "perspective", "perspective": {"yfov": 0.62, "znear": 0.01}}],
    "materials": [
        phong("tiles", diffuseFactor=[0.9, 0.9, 0.9], reflectionFactor=[0.05, 0.05, 0.05],
              diffuseTexture={"index": 0, "extensions": {"KHR_texture_transform": {"scale": [1.5, 1.5]}}}),
        phong("glass", diffuseFactor=[0, 0, 0], specularFactor=[0.8, 0.8, 0.8], shininess=300, reflectionFactor=[1, 1, 1],
              transmissionFactor=[0.97, 0.98, 0.98], ior=1.45, fresnel=True),
        phong("silver", diffuseFactor=[0.03, 0.03, 0.035], specularFactor=[0.85, 0.86, 0.88], shininess=220),
        {"name": "copper", "pbrMetallicRoughness": {"baseColorFactor": [0.95, 0.55, 0.36, 1], "metallicFactor": 1, "roughnessFactor": 0.22}},
        phong("pearl", diffuseFactor=[0.82, 0.8, 0.85], specularFactor=[0.35, 0.35, 0.35], shininess=60, reflectionFactor=[0.12, 0.12, 0.12]),
    ],
    "textures": [{"source": 0, "sampler": 0}],
    "samplers": [{"magFilter": 9728, "wrapS": 10497, "wrapT": 10497}],
    "images": [{"name": "tiles", "uri": data_uri("image/png", png(16, 16, tiles))}],
    "meshes": [{"name": "floor", "primitives": [floor]}, {"name": "ring", "primitives": [ring]}],
    "accessors": accessors,
    "bufferViews": views,
    "buffers": [{"byteLength": len(blob), "uri": data_uri("application/octet-stream", blob)}],
    "extensions": {
        "ALHAZEN_shapes": {"shapes": [{"sphere": {"radius": 1.0}}, {"sphere": {"radius": 0.42}}]},
        "KHR_lights_punctual": {"lights": [
            {"type": "point", "intensity": 0.75, "color": [1, 0.95, 0.86], "extensions": {"ALHAZEN_lights": {"attenuation": "none"}}},
            {"type": "directional", "intensity": 0.2, "color": [0.75, 0.85, 1]}]},
    },
}
with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "showcase.gltf"), "w") as out:
    json.dump(scene, out, indent=1)
