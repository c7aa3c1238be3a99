#!/usr/bin/env python3
"""Measures what docs/benchmarks.md sets as goals: goals.py PROGRAM [ROW...] [FILE...]

Rows: start load fast memory instances scaling efficiency signature; without any, all. Scenes are made in a folder that
is removed again. Times are ratios within one run of the program where the goal is one; other work on the machine makes
the absolute ones larger. `efficiency` and `signature` also take the files given: those without a light of their own get
point lights, three where they have textures and one where not.
"""
import array
import json
import math
import os
import resource
import shutil
import statistics
import struct
import subprocess
import sys
import tempfile
import time
import urllib.parse

PROGRAM = os.path.abspath(sys.argv[1])


def hills(triangles):
    """Positions and indices of a square height field."""
    n = round(math.sqrt(triangles / 2)) + 1
    wave = [math.sin(0.2 * i) + 0.3 * math.sin(1.7 * i) for i in range(n)]
    step = 2 / (n - 1)
    positions, indices = array.array("f"), array.array("I")
    for j in range(n):
        for i in range(n):
            positions.extend((i * step - 1, 0.02 * (wave[i] + wave[j] * wave[i]), j * step - 1))
    for j in range(n - 1):
        for a in range(j * n, j * n + n - 1):
            indices.extend((a, a + n, a + 1, a + 1, a + n, a + n + 1))
    return positions, indices


def write_glb(path, mesh, lights=1, places=None, camera_at=(0, 1.2, 1.9)):
    """A mesh seen by a camera, lit by point lights; `places`: translations of its instances."""
    arrays = [*mesh] + ([places] if places else [])
    views, accessors, offset = [], [], 0
    for values in arrays:
        size = values.itemsize * len(values)
        views.append({"buffer": 0, "byteOffset": offset, "byteLength": size})
        is_index = values.typecode == "I"
        accessors.append({"bufferView": len(views) - 1, "componentType": 5125 if is_index else 5126,
                          "count": len(values) // (1 if is_index else 3), "type": "SCALAR" if is_index else "VEC3"})
        offset += size
    accessors[0].update(min=[min(mesh[0][k::3]) for k in range(3)], max=[max(mesh[0][k::3]) for k in range(3)])
    shown = {"mesh": 0}
    extensions = ["KHR_lights_punctual"]
    if places:
        shown["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 2}}}
        extensions.append("EXT_mesh_gpu_instancing")
    far = camera_at[2]
    nodes = [shown, {"camera": 0, "translation": camera_at, "rotation": [-0.3, 0, 0, 0.954]}]
    nodes += [{"translation": [math.cos(k) * far, 2 * far, math.sin(k) * far],
               "extensions": {"KHR_lights_punctual": {"light": 0}}} for k in range(lights)]
    document = json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes,
        "extensionsUsed": extensions,
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 30 * far * far / lights}]}},
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.01}}],
        "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0}, "doubleSided": True}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": offset}]}).encode()
    document += b" " * (-len(document) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sIIII", b"glTF", 2, 28 + len(document) + offset, len(document), 0x4E4F534A))
        file.write(document + struct.pack("<II", offset, 0x004E4942))
        for values in arrays:
            file.write(values.tobytes())
    return path


def relit(folder, file):
    """The file or, where it has no light, a copy with point lights about it, beside copies of what it refers to."""
    info = json.loads(subprocess.run([PROGRAM, "info", "--json", file], check=True, capture_output=True, text=True).stdout)
    if info["lights"]:
        return file
    with open(file, "rb") as scene:
        data = scene.read()
    binary = data[:4] == b"glTF"
    length = struct.unpack_from("<I", data, 12)[0] if binary else len(data)
    document = json.loads(data[20:20 + length] if binary else data)
    low, high = info["bounds"]["min"], info["bounds"]["max"]
    size = math.dist(low, high)
    lights = 3 if document.get("images") else 1
    nodes = document.setdefault("nodes", [])
    for k in range(lights):
        angle = 0.7 + 2 * math.pi * k / 3
        at = [(a + b) / 2 + size * d for a, b, d in zip(low, high, (math.sin(angle), 0.8, math.cos(angle)))]
        document["scenes"][document.get("scene", 0)]["nodes"].append(len(nodes))
        nodes.append({"translation": at, "extensions": {"KHR_lights_punctual": {"light": 0}}})
    document.setdefault("extensions", {})["KHR_lights_punctual"] = {
        "lights": [{"type": "point", "intensity": 6 * size * size / lights}]}
    document.setdefault("extensionsUsed", []).append("KHR_lights_punctual")
    for item in document.get("buffers", []) + document.get("images", []):
        name = urllib.parse.unquote(item.get("uri", "data:"))
        if not name.startswith("data:"):
            copy = os.path.join(folder, name)
            os.makedirs(os.path.dirname(copy), exist_ok=True)
            shutil.copyfile(os.path.join(os.path.dirname(file), name), copy)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    path = os.path.join(folder, "relit-" + os.path.basename(file))
    with open(path, "wb") as out:
        if binary:
            rest = data[20 + length:]
            out.write(struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A) + text + rest)
        else:
            out.write(text)
    return path


def run(*arguments):
    """Wall and processor seconds."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    subprocess.run([PROGRAM, *arguments], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wall, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def bench(scene, *arguments, size="256x256", repeat=3):
    """The results of `alhazen bench`, one for each number of threads."""
    with tempfile.NamedTemporaryFile("r", suffix=".json", encoding="utf-8") as result:
        run("bench", scene, "--size", size, "--repeat", str(repeat), "--json", result.name, *arguments)
        with open(result.name, encoding="utf-8") as file:  # renamed to there, not written in place
            return json.load(file)["results"]


def least(f, times=5):
    return min(f() for _ in range(times))


def start(folder, _):
    scene = os.path.join(folder, "empty.gltf")
    with open(scene, "w", encoding="utf-8") as file:
        file.write('{"asset": {"version": "2.0"}}')
    for name, command in (("--version", ["--version"]), ("info", ["info", scene]),
                          ("render 16x16", ["render", scene, "-o", scene + ".exr", "--size", "16x16"])):
        wall, processor = least(lambda c=command: run(*c), 9)
        print(f"start and exit, empty scene, {name}: {1e3 * wall:.0f} ms ({1e3 * processor:.0f} ms of processor)")


def load(folder, _):
    for triangles in (1e6, 1e7):
        scene = write_glb(os.path.join(folder, "hills.glb"), hills(triangles))
        runs = [bench(scene, repeat=1)[0] for _ in range(5)]
        ratio = statistics.median(r["first_tile_s"] / r["build_s"] for r in runs)
        speed = os.path.getsize(scene) / statistics.median(r["load_s"] for r in runs)
        share = statistics.median(r["load_s"] / r["build_s"] for r in runs)
        print(f"{triangles:.0e} triangles, robust: GLB to first tile {ratio:.3f} x the build, of it loading {share:.3f}; "
              f"loading {1e-9 * speed:.2f} GB/s")


def fast(folder, _):
    scene = write_glb(os.path.join(folder, "hills.glb"), hills(1e6))
    rows = {}
    for _ in range(5):
        for flags in (("fast",), ("balanced",), ("best",), ("balanced", "--compact"), ("balanced", "--no-robust"),
                      ("best", "--no-robust")):
            result = bench(scene, "--threads", "1", "--build", *flags, repeat=2)[0]
            rows.setdefault(flags, []).append(result)

    def middle(key, value):
        return statistics.median(value(r) for r in rows[key])

    for key in rows:
        pairs = zip(rows[key], rows[("balanced",)])
        build, first, traversal = (statistics.median(p) for p in zip(*(
            (a["build_s"] / b["build_s"], a["first_tile_s"] / b["build_s"],
             statistics.median(a["traversal_s"]) / statistics.median(b["traversal_s"])) for a, b in pairs)))
        size = middle(key, lambda r: r["hierarchy_bytes"] / r["primitives"])
        print(f"{' '.join(key):32} build {build:.2f}, first tile {first:.2f} of the balanced build; {size:.0f} bytes each; "
              f"traversal {traversal:.2f}")


def memory(folder, _):
    scene = write_glb(os.path.join(folder, "hills.glb"), hills(1e6))
    peak = json.loads(subprocess.run([PROGRAM, "render", scene, "-o", scene + ".exr", "--size", "1024x1024", "--progress",
                                      "json"], check=True, capture_output=True, text=True).stdout.splitlines()[-1])
    print(f"peak memory, 1e6 triangles, 1024x1024, robust: {1e-6 * peak['peak_bytes']:.0f} MB")


def instances(folder, _):
    places = array.array("f")
    for k in range(1000000):
        places.extend((2.5 * (k % 100) - 125, 2.5 * (k // 100 % 100) - 125, -2.5 * (k // 10000)))
    scene = write_glb(os.path.join(folder, "million.glb"), hills(1000), places=places, camera_at=(0, 250, 400))
    done = json.loads(subprocess.run([PROGRAM, "render", scene, "-o", scene + ".exr", "--size", "1024x1024", "--progress",
                                      "json"], check=True, capture_output=True, text=True).stdout.splitlines()[-1])
    _, processor = run("render", scene, "-o", scene + ".exr", "--size", "1024x1024")
    print(f"1e6 instances of 1e3 triangles, 1024x1024, robust: {done['seconds']}, {processor:.1f} s of processor, "
          f"{1e-6 * done['peak_bytes']:.0f} MB")


def scaling(folder, _):
    def frame(scene, size, *arguments):
        results = bench(scene, *arguments, size=size, repeat=9)
        return [(min(r["frame_s"]), min(r["traversal_s"])) for r in results]

    small = write_glb(os.path.join(folder, "small.glb"), hills(1e5))
    large = write_glb(os.path.join(folder, "large.glb"), hills(1e6))
    lit = write_glb(os.path.join(folder, "lit.glb"), hills(1e5), lights=10)
    (base, base_rays), = frame(small, "512x512", "--threads", "1")
    for name, factor, scene, size in (("pixels", 4, small, "1024x1024"), ("triangles", 10, large, "512x512"),
                                      ("lights", 10, lit, "512x512")):
        (seconds, rays), = frame(scene, size, "--threads", "1")
        print(f"{name} x {factor}: frame x {seconds / base:.2f} (exponent {math.log(seconds / base, factor):.2f}), "
              f"Embree alone x {rays / base_rays:.2f}")
    one, two = frame(small, "512x512", "--threads", "1,2")
    print(f"threads x 2: {one[0] / two[0]:.2f} times as fast")


def efficiency(folder, files):
    scenes = [write_glb(os.path.join(folder, "hills.glb"), hills(1e6))]
    for name in ("balls", "rings", "tetra"):
        scenes.append(os.path.join(folder, name + ".glb"))
        run("make", name, "-o", scenes[-1])
    for scene in scenes + [relit(folder, file) for file in files]:
        for result in bench(scene, "--threads", f"1,{os.cpu_count()}", size="1024x1024", repeat=9):
            frame = sorted(result["frame_s"])[4]
            shares = ", ".join(f"{name} {100 * seconds / frame:.0f} %" for name, seconds in result["phase_s"].items())
            ratio = statistics.median(t / f for t, f in zip(result["traversal_s"], result["frame_s"]))
            single = statistics.median(f / s for s, f in zip(result["single_ray_traversal_s"], result["frame_s"]))
            print(f"{os.path.basename(scene)}, threads: {result['threads']}, robust: efficiency {ratio:.2f}; frame {single:.2f} x "
                  f"single rays alone; {frame:.2f} s: {shares}", flush=True)


def signature(folder, files):
    for scene in [write_glb(os.path.join(folder, "hills.glb"), hills(1e6))] + files:
        result, = bench(scene, "--threads", "1", "--integrator", "signature", size="1024x1024", repeat=15)
        ratio = statistics.median(t / f for t, f in zip(result["traversal_s"], result["frame_s"]))
        print(f"{os.path.basename(scene)}, signature, 1 thread, robust: efficiency {ratio:.2f}")


ROWS = {"start": start, "load": load, "fast": fast, "memory": memory, "instances": instances, "scaling": scaling,
        "efficiency": efficiency, "signature": signature}

if __name__ == "__main__":
    given = sys.argv[2:]
    for row in [name for name in given if name in ROWS] or ROWS:
        with tempfile.TemporaryDirectory() as work:
            ROWS[row](work, [os.path.abspath(name) for name in given if name not in ROWS])
            sys.stdout.flush()
