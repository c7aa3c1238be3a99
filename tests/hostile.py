"""Small glTF files that ask for much, and what they are made of: for bombs.py and fuzz_seeds.py."""
import base64
import json
import struct
import zlib

FLOAT, UINT, USHORT, UBYTE = 5126, 5125, 5123, 5121


def data_uri(data, mime="application/octet-stream"):
    return f"data:{mime};base64," + base64.b64encode(data).decode()


def gltf(data=b"", **root):
    """A document with one buffer of `data` and one view of all of it."""
    if data:
        root.setdefault("buffers", [{"byteLength": len(data), "uri": data_uri(data)}])
        root.setdefault("bufferViews", [{"buffer": 0, "byteLength": len(data)}])
    return json.dumps({"asset": {"version": "2.0"}, **root}, separators=(",", ":"))


def scene(mesh_primitives, accessors, data=b"", nodes=({"mesh": 0},), **root):
    return gltf(data, accessors=accessors, meshes=[{"primitives": mesh_primitives}], nodes=list(nodes), **root)


def accessor(count, kind="VEC3", component=FLOAT, **more):
    return {"count": count, "type": kind, "componentType": component, **more}


TRIANGLE = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)


def textured(image, mime, where="baseColorTexture", **texture):
    """A triangle with an image, in a data URI."""
    uv = struct.pack("<6f", 0, 0, 1, 0, 0, 1)
    data = TRIANGLE + uv
    return gltf(
        data,
        bufferViews=[{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
        accessors=[accessor(3, bufferView=0), accessor(3, "VEC2", bufferView=1)],
        images=[{"uri": data_uri(image, mime)}],
        textures=[{**({} if texture else {"source": 0}), **texture}],
        materials=[{"pbrMetallicRoughness": {where: {"index": 0}}}],
        meshes=[{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}],
        nodes=[{"mesh": 0}])


# ---- Images whose headers claim more than they hold ----

def png(width, height, rows=0, depth=8, color=2):
    """`rows` of zeros are there, of what the header claims."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    bytes_a_row = 1 + width * {0: 1, 2: 3, 6: 4}[color] * depth // 8
    packer = zlib.compressobj(9)
    packed = b"".join(packer.compress(bytes(bytes_a_row)) for _ in range(rows)) + packer.flush()
    header = struct.pack(">IIBBBBB", width, height, depth, color, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", packed) + chunk(b"IEND", b"")


def jpeg(width, height, progressive=False):
    frame = struct.pack(">BHHB", 8, height, width, 3) + bytes([1, 0x11, 0, 2, 0x11, 0, 3, 0x11, 0])
    quantization = b"\xff\xdb" + struct.pack(">H", 67) + b"\0" + bytes([1] * 64)
    scan = b"\xff\xda" + struct.pack(">H", 12) + bytes([3, 1, 0, 2, 0, 3, 0, 0, 63 if not progressive else 0, 0])
    sof = b"\xff\xc2" if progressive else b"\xff\xc0"
    return b"\xff\xd8" + quantization + sof + struct.pack(">H", 2 + len(frame)) + frame + scan + bytes(100) + b"\xff\xd9"


def webp_lossless(width, height):
    bits = 0x2f | (width - 1) << 8 | (height - 1) << 22 | 0 << 36
    body = bits.to_bytes(5, "little") + bytes(64)
    chunk = b"VP8L" + struct.pack("<I", len(body)) + body + b"\0" * (len(body) % 2)
    return b"RIFF" + struct.pack("<I", 4 + len(chunk)) + b"WEBP" + chunk


def webp_extended(width, height):
    body = bytes([0, 0, 0, 0]) + (width - 1).to_bytes(3, "little") + (height - 1).to_bytes(3, "little")
    chunk = b"VP8X" + struct.pack("<I", len(body)) + body
    inner = webp_lossless(100, 100)[12:]
    return b"RIFF" + struct.pack("<I", 4 + len(chunk) + len(inner)) + b"WEBP" + chunk + inner


def dds(width, height, four_cc=b"DXT1", mipmaps=1):
    pixel_format = struct.pack("<II4s5I", 32, 4, four_cc, 0, 0, 0, 0, 0)
    header = struct.pack("<7I44x", 124, 0x1007, height, width, 0, 0, mipmaps) + pixel_format + struct.pack("<5I", 0x1000, 0, 0, 0, 0)
    return b"DDS " + header + bytes(64)


def bmp(width, height, compression=1):
    info = struct.pack("<IiiHHIIiiII", 40, width, height, 1, 8, compression, 0, 0, 0, 256, 0)
    return b"BM" + struct.pack("<IHHI", 14 + 40 + 1024 + 64, 0, 0, 14 + 40 + 1024) + info + bytes(1024) + bytes(64)


def exr(width, height, channels=("B", "G", "R"), tiled=False):
    def attribute(name, kind, value):
        return name + b"\0" + kind + b"\0" + struct.pack("<I", len(value)) + value
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    listed = b"".join(c.encode() + b"\0" + struct.pack("<IBxxxii", 2, 0, 1, 1) for c in sorted(channels)) + b"\0"
    attributes = [(b"channels", b"chlist", listed), (b"compression", b"compression", b"\x03"),
                  (b"dataWindow", b"box2i", window), (b"displayWindow", b"box2i", window),
                  (b"lineOrder", b"lineOrder", b"\0"), (b"pixelAspectRatio", b"float", struct.pack("<f", 1)),
                  (b"screenWindowCenter", b"v2f", bytes(8)), (b"screenWindowWidth", b"float", struct.pack("<f", 1))]
    if tiled:
        attributes.append((b"tiles", b"tiledesc", struct.pack("<IIB", 1, 1, 0)))
    return b"\x76\x2f\x31\x01" + struct.pack("<I", 2 | (0x200 if tiled else 0)) + b"".join(attribute(*a) for a in attributes) + b"\0" + bytes(64)


def hdr(width, height):
    return f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode() + bytes(64)


def ktx2(width, height):
    head = b"\xabKTX 20\xbb\r\n\x1a\n" + struct.pack("<9I", 37, 1, width, height, 0, 0, 1, 1, 0)
    return head + struct.pack("<4I2Q", 104, 44, 0, 0, 0, 0) + struct.pack("<3Q", 148, 64, 64) + bytes(44 + 64)


def images():
    mimes = {"png": "image/png", "jpeg": "image/jpeg", "webp": "image/webp"}
    yield "png 60000x60000", textured(png(60000, 60000), mimes["png"])
    yield "png 60000x60000 of some rows", textured(png(60000, 60000, 200), mimes["png"])
    yield "png 2^31-1 squared", textured(png(2**31 - 1, 2**31 - 1), mimes["png"])
    yield "png 16384x10000 whole", textured(png(16384, 10000, 10000), mimes["png"])
    yield "png 8192x8192 of 16 bits, some rows", textured(png(8192, 8192, 200, 16, 6), mimes["png"])
    yield "jpeg 65500x65500", textured(jpeg(65500, 65500), mimes["jpeg"])
    yield "progressive jpeg 65500x65500", textured(jpeg(65500, 65500, True), mimes["jpeg"])
    yield "progressive jpeg 10000x10000", textured(jpeg(10000, 10000, True), mimes["jpeg"])
    webp = {"extensions": {"EXT_texture_webp": {"source": 0}}}
    yield "webp 16383x16383", textured(webp_lossless(16383, 16383), mimes["webp"], **webp)
    yield "webp 2^24 squared", textured(webp_extended(1 << 24, 1 << 24), mimes["webp"], **webp)
    as_dds = {"extensions": {"MSFT_texture_dds": {"source": 0}}}
    for size in (65536, 1 << 30, 2**32 - 1, 20000):
        yield f"dds {size} squared", textured(dds(size, size), "image/vnd-ms.dds", **as_dds)
    yield "dds of 2^31 mip levels", textured(dds(4, 4, b"DXT5", 2**31), "image/vnd-ms.dds", **as_dds)
    yield "bmp 60000x60000", textured(bmp(60000, 60000), "image/bmp")
    yield "bmp 60000x60000 not compressed", textured(bmp(60000, 60000, 0), "image/bmp")
    yield "exr 2^30 squared", textured(exr(1 << 30, 1 << 30), "image/x-exr")
    yield "exr 1x2^30", textured(exr(1, 1 << 30), "image/x-exr")
    yield "tiled exr 2^15 squared", textured(exr(1 << 15, 1 << 15, tiled=True), "image/x-exr")
    yield "exr of 32000 channels", textured(exr(8192, 8, [f"c{i}" for i in range(32000)]), "image/x-exr")
    yield "hdr 2^30 squared", textured(hdr(1 << 30, 1 << 30), "image/vnd.radiance")
    as_ktx = {"extensions": {"KHR_texture_basisu": {"source": 0}}}
    yield "ktx2 2^31 squared", textured(ktx2(1 << 31, 1 << 31), "image/ktx2", **as_ktx)
    # One image behind very many textures and materials; many images of one buffer view.
    picture = png(2048, 2048, 2048)
    count = 5000
    yield "thousands of materials with one texture", gltf(
        images=[{"uri": data_uri(picture)}], textures=[{"source": 0}] * count,
        materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": i}}} for i in range(count)],
        **triangles_of_materials(count))
    yield "thousands of images of one view", gltf(
        picture, images=[{"bufferView": 0, "mimeType": "image/png"}] * count,
        textures=[{"source": i} for i in range(count)],
        materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": i}}} for i in range(count)],
        accessors=[accessor(3)],
        meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "material": i} for i in range(count)]}],
        nodes=[{"mesh": 0}])
    glossy = {"KHR_materials_pbrSpecularGlossiness": {"specularGlossinessTexture": {"index": 0}}}
    yield "thousands of roughness images of one", gltf(
        images=[{"uri": data_uri(png(2048, 2048, 2048, 8, 6))}], textures=[{"source": 0}],
        materials=[{"extensions": {"KHR_materials_pbrSpecularGlossiness": {
            **glossy["KHR_materials_pbrSpecularGlossiness"], "glossinessFactor": i / count}}} for i in range(count)],
        **triangles_of_materials(count))


def triangles_of_materials(count):
    return {"buffers": [{"byteLength": 36, "uri": data_uri(TRIANGLE)}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "accessors": [accessor(3, bufferView=0)],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": i} for i in range(count)]}],
            "nodes": [{"mesh": 0}]}


# ---- Numbers, meshes, instances ----

def numbers():
    sparse = {"count": 1, "indices": {"bufferView": 0, "componentType": UINT}, "values": {"bufferView": 0}}
    attributes = {"POSITION": 0, "NORMAL": 0, "TANGENT": 1, "COLOR_0": 1, **{f"TEXCOORD_{i}": 2 for i in range(8)}}
    for count in (4_000_000_000, 1 << 24, 4_000_000, 2_000_000, 600_000):
        yield f"{count} vertices of no bytes", scene(
            [{"attributes": attributes}], [accessor(count), accessor(count, "VEC4"), accessor(count, "VEC2")])
    yield "4e9 sparse vertices", scene([{"attributes": {"POSITION": 0}}], [accessor(4_000_000_000, sparse=sparse)], TRIANGLE)
    yield "4e9 vertices of 36 bytes", scene([{"attributes": {"POSITION": 0}}], [accessor(4_000_000_000, bufferView=0)], TRIANGLE)
    yield "2^24 indices of no bytes", scene(
        [{"attributes": {"POSITION": 0}, "indices": 1, "mode": 5}], [accessor(3), accessor(1 << 24, "SCALAR", UINT)])
    for count in (3_000, 20_000):
        yield f"{count} primitives of one accessor of 10000 vertices", scene(
            [{"attributes": {"POSITION": 0}}] * count, [accessor(10_000)])
    yield "meshes that share all bytes", gltf(
        bytes(300_000), accessors=[accessor(25_000, bufferView=0)],
        meshes=[{"primitives": [{"attributes": {"POSITION": 0}}]}] * 8000,
        nodes=[{"mesh": i} for i in range(8000)])
    yield "a mesh of 5000 triangles at 20000 nodes", scene(
        [{"attributes": {"POSITION": 0}, "mode": 5}], [accessor(5_000, bufferView=0)], bytes(60_000),
        [{"mesh": 0, "translation": [i % 100, i // 100, 0]} for i in range(15_000)])
    yield "views that share a buffer", gltf(
        bytes(200_000), bufferViews=[{"buffer": 0, "byteLength": 200_000}] * 20_000)
    yield "a gigabyte for a buffer of no bytes", gltf(buffers=[{"byteLength": 1 << 40, "uri": data_uri(b"")}],
                                                      bufferViews=[{"buffer": 0, "byteLength": 1 << 40}])
    yield "data URI of a percent sign and megabytes of zeros", gltf(
        buffers=[{"byteLength": 1 << 30, "uri": "data:," + "%00" * 300_000}],
        bufferViews=[{"buffer": 0, "byteLength": 1 << 30}])
    huge = {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1}}}
    for count in (4_000_000_000, 1 << 24, 1_000_000, 60_000):
        yield f"{count} instances of no bytes", scene(
            [{"attributes": {"POSITION": 0}}], [accessor(3, bufferView=0), accessor(count)], TRIANGLE,
            [{"mesh": 0, "extensions": huge}], extensionsUsed=["EXT_mesh_gpu_instancing"])
    yield "instances that share their bytes", gltf(
        bytes(600_000), bufferViews=[{"buffer": 0, "byteLength": 600_000}],
        accessors=[accessor(3, bufferView=0), accessor(50_000, bufferView=0)],
        meshes=[{"primitives": [{"attributes": {"POSITION": 0}}]}],
        nodes=[{"mesh": 0, "extensions": huge}] * 2000, extensionsUsed=["EXT_mesh_gpu_instancing"])
    normal_mapped = {"materials": [{"normalTexture": {"index": 0}}], "textures": [{}]}
    yield "tangents for millions of vertices of no bytes", scene(
        [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}], [accessor(1_500_000), accessor(1_500_000, "VEC2")],
        **normal_mapped)


def streams(size=700_000):
    """Compressed streams of `size` zeros that claim far more."""
    for mode, count, stride in (("ATTRIBUTES", 4_000_000_000, 256), ("ATTRIBUTES", 4_000_000, 256), ("TRIANGLES", 4_000_000_002, 4),
                                ("TRIANGLES", 1_500_000, 4), ("INDICES", 4_000_000_000, 4), ("INDICES", 700_000, 4)):
        head = {"ATTRIBUTES": b"\xa0", "TRIANGLES": b"\xe1", "INDICES": b"\xd1"}[mode]
        data = head + bytes(size)
        compressed = {"buffer": 0, "byteLength": len(data), "byteStride": stride, "count": count, "mode": mode}
        yield f"meshopt {mode} of {count}", gltf(
            data, bufferViews=[{"buffer": 0, "byteLength": count * stride, "extensions": {"EXT_meshopt_compression": compressed}}],
            buffers=[{"byteLength": len(data), "uri": data_uri(data)}], extensionsUsed=["EXT_meshopt_compression"],
            accessors=[accessor(3, "SCALAR", UBYTE, bufferView=0)])
    data = b"\xa0" + bytes(size)
    compressed = {"buffer": 0, "byteLength": len(data), "byteStride": 256, "count": 1_500_000, "mode": "ATTRIBUTES"}
    yield "meshopt views that share a stream", gltf(
        data, bufferViews=[{"buffer": 0, "byteLength": 384_000_000, "extensions": {"EXT_meshopt_compression": compressed}}] * 100,
        buffers=[{"byteLength": len(data), "uri": data_uri(data)}])
    for vertices, triangles in ((2**32 - 1, 2**32 - 1), (3_000_000, 1_000_000), (1 << 28, 10)):
        for method in (0, 1):
            varint = lambda n: bytes([n >> s & 127 | (128 if n >> (s + 7) else 0) for s in range(0, 35, 7) if s == 0 or n >> s])
            head = b"DRACO" + bytes([2, 2, 1, method]) + bytes(2)
            sizes = varint(triangles) + varint(vertices) if method == 0 else b"\0" + varint(vertices) + varint(triangles)
            data = head + sizes + bytes(size)
            yield f"draco {vertices} vertices, {triangles} triangles, method {method}", scene(
                [{"attributes": {"POSITION": 0}, "indices": 1,
                  "extensions": {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}}}],
                [accessor(min(vertices, 2**32 - 2)), accessor(min(3 * triangles, (2**32 - 2) // 3 * 3), "SCALAR", UINT)], data,
                extensionsUsed=["KHR_draco_mesh_compression"])


# ---- JSON, hierarchies ----

def documents():
    head = '{"asset":{"version":"2.0"},'
    yield "brackets", "[" * (1 << 20)
    yield "objects in objects", '{"a":' * 200_000
    yield "extras of many empty arrays", head + '"extras":[' + ",".join(["[]"] * 340_000) + "]}"
    yield "extras of many keys", head + '"extras":{' + ",".join(f'"{i:x}":0' for i in range(100_000)) + "}}"
    for key in ("nodes", "materials", "textures", "images", "samplers", "scenes", "bufferViews", "buffers"):
        yield f"340000 {key}", head + f'"{key}":[' + ",".join(["{}"] * 340_000) + "]}"
    yield "30000 nodes with a mesh each", gltf(TRIANGLE, accessors=[accessor(3, bufferView=0)],
                                               meshes=[{"primitives": [{"attributes": {"POSITION": 0}}]}] * 15_000,
                                               nodes=[{"mesh": i} for i in range(15_000)])
    yield "accessors of nothing", gltf(accessors=[accessor(1)] * 15_000)
    yield "meshes of many empty primitives", gltf(meshes=[{"primitives": [{"attributes": {}}] * 50_000}])
    yield "a number of a million digits", head + '"extras":' + "1" * 1_000_000 + "}"
    yield "a chain of 40000 nodes", gltf(nodes=[{"children": [i + 1]} for i in range(40_000)] + [{}])
    yield "a cycle", gltf(nodes=[{"children": [1]}, {"children": [0]}])
    yield "shared children, doubling", gltf(nodes=[{"children": [i + 1, i + 1]} for i in range(64)] + [{}])
    yield "shared children of two parents", gltf(
        nodes=[{"children": [2 * i // 2 + 2, 2 * i // 2 + 3]} for i in range(64)] + [{}, {}, {}])
    yield "a node of 300000 children", gltf(nodes=[{"children": list(range(1, 60_000))}] + [{}] * 60_000)
    ball = {"sphere": {"radius": 1}}
    for arity, depth in ((2, 60), (2, 18), (300, 3), (1, 3000)):
        shapes = [ball] + [{"composite": {"operation": "union", "operands": [{"shape": i}] * max(arity, 2) if arity > 1
                            else [{"shape": i}, {"shape": 0}]}} for i in range(depth)]
        yield f"composites of {arity} operands, {depth} deep", gltf(
            extensionsUsed=["ALHAZEN_shapes"], extensions={"ALHAZEN_shapes": {"shapes": shapes}},
            nodes=[{"extensions": {"ALHAZEN_shapes": {"shape": len(shapes) - 1}}}])
    bodies = [ball, {"composite": {"operation": "union", "operands": [{"shape": 0}] * 40}}]
    yield "thousands of composites in one place", gltf(
        extensionsUsed=["ALHAZEN_shapes"], extensions={"ALHAZEN_shapes": {"shapes": bodies}},
        nodes=[{"extensions": {"ALHAZEN_shapes": {"shape": 1}}}] * 4_000)
    shapes = [ball] + [{"composite": {"operation": "union", "operands": [{"shape": 0}] * 40}}] * 15_00
    yield "composites at thousands of nodes", gltf(
        extensionsUsed=["ALHAZEN_shapes"], extensions={"ALHAZEN_shapes": {"shapes": shapes[:500]}},
        nodes=[{"translation": [3 * (i % 90), 3 * (i // 90), 0], "extensions": {"ALHAZEN_shapes": {"shape": 1 + i % 499}}}
               for i in range(8_000)])
    lights = {"KHR_lights_punctual": {"lights": [{"type": "point"}]}}
    yield "thousands of lights", gltf(TRIANGLE, accessors=[accessor(3, bufferView=0)],
                                      meshes=[{"primitives": [{"attributes": {"POSITION": 0}}]}], extensions=lights,
                                      nodes=[{"mesh": 0}] + [{"extensions": {"KHR_lights_punctual": {"light": 0}}}] * 15_000)
