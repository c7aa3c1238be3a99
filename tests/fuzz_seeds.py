"""Small files to begin fuzzing with: fuzz_seeds.py FOLDER [FILE...] writes them there, and copies those FILEs that are small."""
import json
import os
import shutil
import struct
import sys

import hostile
from hostile import FLOAT, UBYTE, UINT, USHORT, accessor, data_uri, gltf, textured

LARGEST_COPY = 64 << 10


def glb(document, data):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    data += bytes(-len(data) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def everything():
    """What the loader reads of a mesh, material, node, camera, light and shape, in one document and its bytes."""
    parts = [struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0), struct.pack("<9f", *[0, 0, 1] * 3), struct.pack("<6f", 0, 0, 1, 0, 0, 1),
             struct.pack("<12f", *[1, 0, 0, 1] * 3), bytes([255] * 12), struct.pack("<4H", 0, 1, 2, 0), struct.pack("<2H", 0, 2),
             bytes(24), hostile.png(2, 2, 2, 8, 6)]
    views, at = [], 0
    for part in parts:
        views.append({"buffer": 0, "byteOffset": at, "byteLength": len(part)})
        at += len(part) + -len(part) % 4
    data = b"".join(part + bytes(-len(part) % 4) for part in parts)
    texture = {"index": 0, "extensions": {"KHR_texture_transform": {"offset": [0, 1], "rotation": 1, "scale": [1, 2]}}}
    sparse = {"count": 2, "indices": {"bufferView": 6, "componentType": USHORT}, "values": {"bufferView": 7}}
    materials = [
        {"alphaMode": "MASK", "normalTexture": {**texture, "scale": 1}, "occlusionTexture": texture, "emissiveTexture": texture,
         "pbrMetallicRoughness": {"baseColorTexture": texture, "metallicRoughnessTexture": texture},
         "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": {"thicknessFactor": 1},
                        "KHR_materials_clearcoat": {"clearcoatFactor": 1}, "KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1]},
                        "KHR_materials_iridescence": {"iridescenceFactor": 1}, "KHR_materials_anisotropy": {"anisotropyStrength": 1},
                        "KHR_materials_ior": {"ior": 1.3}, "KHR_materials_dispersion": {"dispersion": 1}}},
        {"alphaMode": "BLEND", "extensions": {"KHR_materials_pbrSpecularGlossiness": {"specularGlossinessTexture": texture}}},
        {"extensions": {"ALHAZEN_materials_phong": {"diffuseFactor": [1, 1, 1], "diffuseTexture": texture}}}]
    attributes = {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2, "TANGENT": 3, "COLOR_0": 4}
    shapes = [{"sphere": {"radius": 1}}, {"box": {"size": [1, 2, 3]}}, {"cylinder": {"radiusTop": 0}}, {"disk": {"innerRadius": 0.5}},
              {"polygon": {"loops": [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]]}}, {"quadric": {"coefficients": [1, 1, 1, 0, 0, 0, 0, 0, 0, -1]}},
              {"composite": {"operation": "difference", "operands": [{"shape": 1}, {"shape": 0}]}}]
    nodes = [{"mesh": 0, "children": [1, 2]}, {"camera": 0, "translation": [0, 0, 5]},
             {"extensions": {"KHR_lights_punctual": {"light": 0}}, "rotation": [0, 0, 0, 1]},
             {"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0, "SCALE": 0}}}}]
    nodes += [{"extensions": {"ALHAZEN_shapes": {"shape": k, "material": k % 3}}, "scale": [1, 2, 1]} for k in range(len(shapes))]
    document = {
        "asset": {"version": "2.0"}, "buffers": [{"byteLength": len(data)}], "bufferViews": views,
        "accessors": [accessor(3, bufferView=0, min=[0, 0, 0], max=[1, 1, 0]), accessor(3, bufferView=1), accessor(3, "VEC2", bufferView=2),
                      accessor(3, "VEC4", bufferView=3), accessor(3, "VEC4", UBYTE, bufferView=4, normalized=True),
                      accessor(3, "SCALAR", USHORT, bufferView=5), accessor(3, sparse=sparse)],
        "images": [{"bufferView": 8, "mimeType": "image/png"}], "samplers": [{"minFilter": 9987}],
        "textures": [{"source": 0, "sampler": 0}], "materials": materials,
        "meshes": [{"primitives": [{"attributes": attributes, "indices": 5, "material": 0},
                                   {"attributes": {"POSITION": 6}, "mode": 5, "material": 1},
                                   {"attributes": {"POSITION": 0}, "mode": 6, "targets": [{"POSITION": 1}]}]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}], "nodes": nodes,
        "scenes": [{"nodes": [0, *range(3, len(nodes))]}], "scene": 0,
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {}}]}, "ALHAZEN_shapes": {"shapes": shapes}}}
    return document, data


def seeds():
    document, data = everything()
    yield "everything.glb", glb(document, data)
    document["buffers"][0]["uri"] = data_uri(data)
    yield "everything.gltf", json.dumps(document).encode()
    pictures = {"png": hostile.png(3, 3, 3), "deep.png": hostile.png(3, 3, 3, 16, 6), "jpg": hostile.jpeg(8, 8),
                "progressive.jpg": hostile.jpeg(8, 8, True), "webp": hostile.webp_lossless(3, 3), "bmp": hostile.bmp(4, 4),
                "dds": hostile.dds(4, 4), "exr": hostile.exr(3, 3), "hdr": hostile.hdr(8, 3), "ktx2": hostile.ktx2(4, 4)}
    for name, picture in pictures.items():
        yield f"image.{name}.gltf", textured(picture, "image/png").encode()
    for name, text in hostile.streams(8):
        yield name.replace(" ", "_").replace(",", "") + ".gltf", text.encode()


def main():
    folder = sys.argv[1]
    os.makedirs(folder, exist_ok=True)
    for name, contents in seeds():
        with open(os.path.join(folder, name), "wb") as out:
            out.write(contents)
    for number, file in enumerate(sys.argv[2:]):
        if os.path.getsize(file) <= LARGEST_COPY:
            shutil.copy(file, os.path.join(folder, f"{number}-{os.path.basename(file)}"))


main()
