"""The program as other programs and people at a terminal meet it: cli.py PROGRAM SHOWCASE"""
import base64
import json
import os
import pty
import signal
import statistics
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree

PROGRAM, SCENE = sys.argv[1], sys.argv[2]


def run(*arguments, **environment):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, env={**os.environ, **environment})


class CommandLine(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def file(self, name):
        return os.path.join(self.folder.name, name)

    def render(self, name, *options, **environment):
        return run("render", SCENE, "-o", self.file(name), "--size", "96x54", *options, **environment)

    def test_progress_json_is_an_object_a_line_and_ends_with_the_facts(self):
        result = self.render("a.exr", "--progress", "json", "--size", "480x270", "--spp", "8")
        lines = [json.loads(line) for line in result.stdout.splitlines()]
        progress, facts = lines[:-1], lines[-1]
        progress = [line for line in progress if line["event"] != "loading"]  # where that takes more than a second
        self.assertEqual({line["event"] for line in progress} | {"progress"}, {"progress"})
        fractions = [line["fraction"] for line in progress]
        self.assertEqual(fractions, sorted(fractions))
        self.assertEqual((facts["event"], facts["pixels"]), ("done", 480 * 270))
        self.assertEqual(facts["rays"]["camera"], 480 * 270 * 8)
        self.assertLess(facts["doubts"], 1e-4 * sum(facts["rays"].values()))
        self.assertEqual(set(facts["seconds"]), {"load", "build", "render", "write"})
        self.assertGreater(facts["peak_bytes"], 1e6)
        self.assertEqual(result.stderr, "")

    def test_nothing_but_plain_lines_without_a_terminal(self):
        result = self.render("a.exr")
        self.assertEqual(result.stderr, "")
        self.assertRegex(result.stdout, r"^done: load .* s, build .* s, render .* s, write .* s; .* rays \(.* camera, ")
        self.assertEqual(len(result.stdout.splitlines()), 1)

    def test_quiet_says_nothing(self):
        result = self.render("a.png", "--quiet", "--exposure", "6")
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))

    def test_a_terminal_shows_one_line_and_wipes_it(self):
        master, slave = pty.openpty()
        process = subprocess.Popen([PROGRAM, "render", SCENE, "-o", self.file("a.exr"), "--size", "640x360", "--spp", "32"],
                                   stdout=slave, stderr=slave,
                                   env={**os.environ, "TERM": "xterm"})
        os.close(slave)
        text = b""
        while True:
            try:
                chunk = os.read(master, 4096)
            except OSError:  # the other side is closed
                break
            if not chunk:
                break
            text += chunk
        process.wait()
        os.close(master)
        self.assertEqual(process.returncode, 0)
        progress, _, facts = text.decode().rpartition("\r\x1b[K")  # nothing to wipe where it took no time
        self.assertNotIn("\n", progress)
        self.assertRegex(facts, r"^done: .*\r\n$")
        if progress:
            self.assertRegex(progress, r"\[\d+/\d+ tiles +\d+%\]  [\d.]+ Mray/s  .* elapsed")

    def test_info_counts_what_the_file_holds(self):
        info = json.loads(run("info", SCENE, "--json").stdout)
        with open(SCENE, encoding="utf-8") as file:
            gltf = json.load(file)
        for key in ("nodes", "meshes", "materials", "textures", "images"):
            self.assertEqual(info[key], len(gltf[key]), key)
        triangles = sum(gltf["accessors"][p["indices"]]["count"] // 3 for m in gltf["meshes"] for p in m["primitives"])
        self.assertEqual(info["triangles"], triangles)
        self.assertGreater(info["load_s"], 0)
        self.assertRegex(run("info", SCENE).stdout, r"\nloading +[0-9.]+ s, ")
        self.assertEqual(info["shapes"], len(gltf["extensions"]["ALHAZEN_shapes"]["shapes"]))
        self.assertEqual(len(info["lights"]), len(gltf["extensions"]["KHR_lights_punctual"]["lights"]))
        self.assertEqual([c["name"] for c in info["cameras"]], [c["name"] for c in gltf["cameras"]])
        self.assertEqual({e["name"]: e["treatment"] for e in info["extensions"]},
                         {name: "supported" for name in gltf["extensionsUsed"]})
        self.assertEqual(len(info["bounds"]["min"]), 3)

    def test_info_says_which_extensions_are_ignored(self):
        with open(self.file("x.gltf"), "w", encoding="utf-8") as file:
            json.dump({"asset": {"version": "2.0"}, "extensionsUsed": ["X_unheard"]}, file)
        info = json.loads(run("info", self.file("x.gltf"), "--json").stdout)
        self.assertEqual(info["extensions"], [{"name": "X_unheard", "required": False, "treatment": "ignored",
                                               "meaning": "not known, what it brings is left out"}])
        self.assertEqual((info["nodes"], info["bounds"], info["cameras"]), (0, None, []))

    def moving_triangle(self):
        """A triangle that crosses the view within a second, before one that stands, and a camera."""
        numbers = struct.pack("<9f2f6f", 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, -2, 0, 0, 2, 0, 0)
        views = [{"buffer": 0, "byteOffset": at, "byteLength": n} for at, n in ((0, 36), (36, 8), (44, 24))]
        accessors = [{"bufferView": i, "componentType": 5126, "type": t, "count": n}
                     for i, (t, n) in enumerate((("VEC3", 3), ("SCALAR", 2), ("VEC3", 2)))]
        uri = "data:application/octet-stream;base64," + base64.b64encode(numbers).decode()
        scene = {"asset": {"version": "2.0"}, "buffers": [{"byteLength": len(numbers), "uri": uri}],
                 "bufferViews": views, "accessors": accessors,
                 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}] * 2,
                 "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}],
                 "nodes": [{"mesh": 0}, {"mesh": 1, "translation": [0, 0, -1]}, {"camera": 0, "translation": [0, 0, 5]}],
                 "animations": [{"name": "cross", "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                                 "samplers": [{"input": 1, "output": 2}]}]}
        with open(self.file("moving.gltf"), "w", encoding="utf-8") as file:
            json.dump(scene, file)
        return self.file("moving.gltf")

    def test_frames_of_a_sequence_are_the_stills_at_their_times(self):
        scene = self.moving_triangle()
        options = ["--size", "48x32", "--quiet"]
        date = {"SOURCE_DATE_EPOCH": "1700000000"}
        result = run("render", scene, "-o", self.file("f.##.png"), "--frames", "0:8:2", "--fps", "8", *options, **date)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        frames = set()
        for n in range(0, 9, 2):
            run("render", scene, "-o", self.file("still.png"), "--time", str(n / 8), *options, **date)
            with open(self.file("still.png"), "rb") as still, open(self.file(f"f.0{n}.png"), "rb") as frame:
                frames.add(frame.read())
                frame.seek(0)
                self.assertEqual(still.read(), frame.read())
        self.assertEqual(len(frames), 5)
        info = json.loads(run("info", scene, "--json").stdout)
        self.assertEqual((info["animations"], info["skins"]), (["cross"], 0))

    def test_frames_ask_for_what_they_need(self):
        scene = self.moving_triangle()
        for options, expected in ((["-o", "f.png", "--frames", "1:3"], "no place for the number"),
                                  (["-o", "f.#.png", "--frames", "1:3:-1"], "is not FIRST:LAST"),
                                  (["-o", "f.#.png", "--frames", "one"], "is not FIRST:LAST"),
                                  (["-o", "f.#.png", "--frames", "1:3", "--time", "1"], "times of their own"),
                                  (["-o", self.file("f.png"), "--animation", "walk"], "the file has 0 'cross'")):
            result = run("render", scene, *options)
            self.assertEqual(result.returncode, 2, options)
            self.assertIn(expected, result.stderr)

    def test_an_open_shutter_blurs_what_moves(self):
        scene = self.moving_triangle()
        date = {"SOURCE_DATE_EPOCH": "1700000000"}

        def picture(*options, name="p.png"):
            result = run("render", scene, "-o", self.file(name), "--size", "48x32", "--spp", "4", "--quiet", *options, **date)
            self.assertEqual((result.returncode, result.stderr), (0, ""), options)
            with open(self.file(name.replace("#", "0")), "rb") as file:
                return file.read()

        still, blurred = picture("--time", "0"), picture("--time", "0", "--shutter", "0.25")
        self.assertEqual(picture("--time", "0", "--shutter", "0"), still)
        self.assertNotEqual(still, blurred)
        self.assertEqual(picture("--shutter", "0.25"), blurred)  # opens at 0 s where no time is given
        self.assertEqual(picture("--frames", "0", "--shutter", "0.25", name="f.#.png"), blurred)
        self.assertEqual(picture("--time", "0", "--shutter", "0.25", "--threads", "1", "--tile-size", "8"), blurred)

    def test_a_shutter_where_nothing_moves_is_a_note(self):
        result = self.render("a.exr", "--shutter", "0.5")
        self.assertEqual(result.returncode, 0)
        self.assertEqual(result.stderr, "note: --shutter: no animation is played, so nothing moves\n")
        self.assertEqual(self.render("a.exr", "--shutter", "0.5", "--quiet").stderr, "")

    def test_shutters_that_cannot_be_are_wrong_usage(self):
        for value in ("-0.1", "nan", "inf", "long", "1s"):
            result = self.render("a.exr", "--shutter=" + value)
            self.assertEqual(result.returncode, 2, value)
            self.assertIn("--shutter: '" + value + "' is not a time in seconds", result.stderr)
        result = self.render("a.exr", "--shutter", "1", "--integrator", "signature")
        self.assertEqual((result.returncode, "one moment" in result.stderr), (2, True))

    def test_misspelled_words_bring_the_nearest(self):
        for arguments, expected in (
            (["rendr", SCENE], "did you mean 'render'?"),
            (["render", SCENE, "--ouput", "a.png"], "did you mean '--output'?"),
            (["render", SCENE, "--smaples=3", "-o", "a.png"], "unknown option '--smaples'"),
            (["render", SCENE, "-o", "a.png", "--integrator", "whited"], "did you mean 'whitted'?"),
            (["render", SCENE, "-o", self.file("a.png"), "--camera", "frnt"], "the scene has 0 'front'; did you mean"),
            (["info", SCENE, "--jsn"], "did you mean '--json'?"),
            ([], "expected a command: render, info, signature"),
        ):
            result = run(*arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertIn(expected, result.stderr)
            self.assertEqual(len(result.stderr.splitlines()), 1)

    def test_bench_climbs_the_ladder(self):
        lines = run("bench", "--ladder", SCENE, "--size", "16x12").stdout.splitlines()
        self.assertEqual(lines[0].split(), ["accelerator", "us/ray", "primitives/ray", "boxes/ray", "speed-up"])
        names = [line[:17].strip() for line in lines[1:]]
        self.assertEqual(names, ["every primitive", "object boxes", "node tree", "image rectangles", "Embree"])

    def test_bench_sets_a_frame_beside_what_embree_takes(self):
        result = run("bench", SCENE, "--size", "64x48", "--threads", "1,2", "--repeat", "6", "--json", self.file("a.json"),
                     "--plot", self.file("a.svg"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, r"Embree alone [\d.]+ s, efficiency [\d.]+ ")
        self.assertRegex(result.stdout, r"scaling: 1 threads 1.00 x, 2 threads [\d.]+ x")
        with open(self.file("a.json"), encoding="utf-8") as file:
            report = json.load(file)
        self.assertEqual([r["threads"] for r in report["results"]], [1, 2])
        for r in report["results"]:
            self.assertEqual(r["rays"]["camera"], 64 * 48)
            self.assertEqual(sum(kind["rays"] for kind in r["bare"].values()), sum(r["rays"].values()))
            self.assertEqual([len(r[k]) for k in ("frame_s", "traversal_s", "single_ray_traversal_s")], [6, 6, 6])
            self.assertLess(0, r["efficiency"])
        bars = {e.get("class"): float(e.get("width")) for e in xml.etree.ElementTree.parse(self.file("a.svg")).iter()
                if e.tag.endswith("rect") and e.get("class")}
        last = report["results"][-1]
        rates = {name: 2 * kind["rays"] / kind["seconds_of_all_threads"] for name, kind in last["bare"].items()}
        rates["frame"] = sum(last["rays"].values()) / statistics.median(last["frame_s"])
        self.assertEqual(bars.keys(), rates.keys())
        for name, rate in rates.items():
            self.assertAlmostEqual(bars[name] / max(bars.values()), rate / max(rates.values()), places=3)

    def test_bench_tells_what_became_slower(self):
        bench = ["bench", SCENE, "--size", "32x24", "--threads", "1", "--repeat", "6"]
        self.assertEqual(run(*bench, "--json", self.file("now.json")).returncode, 0)
        with open(self.file("now.json"), encoding="utf-8") as file:
            report = json.load(file)
        for factor, status, word in ((0.01, 6, "SLOWER"), (100, 0, "faster")):
            for r in report["results"]:
                r["frame_s"] = [1e-3 * factor * (1 + 0.01 * k) for k in range(6)]
            with open(self.file("before.json"), "w", encoding="utf-8") as file:
                json.dump(report, file)
            result = run(*bench, "--compare", self.file("before.json"))
            self.assertEqual(result.returncode, status, result.stdout + result.stderr)
            self.assertIn(word, result.stdout)
        self.assertEqual(run(*bench, "--compare", SCENE).returncode, 3)
        self.assertEqual(run(*bench, "--json", self.file("x/a.json")).returncode, 4)

    def test_bench_says_how_the_hierarchy_was_built(self):
        bench = ["bench", SCENE, "--size", "32x24", "--threads", "1", "--repeat", "2"]
        result = run(*bench, "--build", "fast", "--compact", "--no-robust", "--breakdown", "--json", self.file("now.json"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("1 thread, fast, not robust, compact", result.stdout)
        self.assertRegex(result.stdout, r"Embree alone +[0-9.]+ % +[0-9.]+ ms +[0-9.]+ ns a ray")
        with open(self.file("now.json"), encoding="utf-8") as file:
            report = json.load(file)["results"][0]
        self.assertEqual((report["build"], report["robust"], report["compact"]), ("fast", False, True))
        self.assertIn("nothing to compare", run(*bench, "--compare", self.file("now.json")).stdout)
        unknown = run(*bench, "--build", "fat")
        self.assertEqual(unknown.returncode, 2)
        self.assertIn("expected one of fast, balanced, best", unknown.stderr)

    def test_a_benchmark_scene_is_made_and_rendered(self):
        result = run("make", "balls", "--size", "1", "-o", self.file("balls.glb"))
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertIn("10 spheres, 0 cones, 1 polygons, 3 lights", result.stdout)
        self.assertEqual(run("render", self.file("balls.glb"), "-o", self.file("a.png"), "--size", "32x32").returncode, 0)
        self.assertIn("did you mean 'teapot'?", run("make", "teapt", "-o", self.file("a.glb")).stderr)
        self.assertEqual(run("make", "balls", "--size", "9", "-o", self.file("a.glb")).returncode, 2)
        self.assertEqual(run("make", "balls", "--size", "1", "-o", self.file("x/a.glb")).returncode, 4)
        with open(self.file("a.nff"), "w", encoding="utf-8") as file:
            file.write("s 0 0 0 1\n")
        self.assertEqual(run("convert", self.file("a.nff"), "-o", self.file("b.glb")).returncode, 0)
        self.assertEqual(json.loads(run("info", self.file("b.glb"), "--json").stdout)["shapes"], 1)
        self.assertEqual(run("convert", self.file("b.glb"), "-o", self.file("c.glb")).returncode, 3)

    def test_a_sheet_shows_every_model_and_why_one_is_missing(self):
        os.mkdir(self.file("models"))
        os.symlink(os.path.dirname(SCENE), self.file("models/linked"))  # is not followed
        for name, text in (("a.gltf", '{"asset":{"version":"2.0"}}'), ("b.gltf", "{"), ("C.GLTF", '{"asset":{"version":"2.0"}}'), ("d.txt", "")):
            with open(self.file("models/" + name), "w", encoding="utf-8") as file:
                file.write(text)
        result = run("sheet", self.file("models"), "-o", self.file("s.ppm"), "--size", "40x30", "--columns", "2",
                     "--render-options", "--background 1,0,0 --spp 2")
        self.assertEqual(result.returncode, 3)
        lines = result.stdout.splitlines()
        self.assertEqual([line.split(":")[0] for line in lines], ["C.GLTF", "a.gltf", "b.gltf", "2 of 3 models rendered"])
        self.assertRegex(lines[0], r"load [\d.]+ s, render [\d.]+ s, \d+ MB$")
        self.assertIn("b.gltf", lines[2])
        with open(self.file("s.ppm"), "rb") as file:
            header, pixels = file.read().split(b"\n255\n", 1)
        width, height = map(int, header.split()[1:3])
        self.assertEqual((width, height), (6 + 2 * 46, 6 + 2 * 72))
        at = lambda x, y: tuple(pixels[3 * (y * width + x):][:3])
        self.assertEqual([at(26, 20), at(72, 20)], [(255, 0, 0)] * 2)
        self.assertNotEqual(at(26, 92), (255, 0, 0))
        self.assertEqual(run("sheet", self.folder.name + "/absent", "-o", self.file("s.png")).returncode, 3)
        self.assertEqual(run("sheet", self.file("models"), "-o", self.file("x/s.png")).returncode, 4)

    def test_a_signature_names_what_is_seen_and_differs_from_another(self):
        picture, ids = self.file("objects.png"), self.file("ids.exr")
        result = run("signature", SCENE, "-o", ids, "--size", "96x54", "--json")
        report = json.loads(result.stdout)
        self.assertEqual(result.returncode, 0)
        self.assertEqual(sum(o["pixels"] for o in report["objects"]) + report["background"], 96 * 54)
        self.assertEqual([o["name"] for o in report["objects"]], ["floor", "glass", "mirror", "ring", "pearl"])
        same = run("signature", SCENE, "--diff", ids, "-o", picture, "--legend")
        self.assertEqual((same.returncode, same.stdout.splitlines()[-1]), (0, "the same as " + ids))
        self.assertTrue(os.path.exists(picture))
        other = run("signature", SCENE, "--diff", ids, "--lights", "scene")
        self.assertEqual(other.returncode, 2)
        ring = run("render", SCENE, "-o", self.file("a.exr"), "--size", "96x54", "--quiet")
        self.assertEqual(ring.returncode, 0)
        no_signature = run("signature", SCENE, "--diff", self.file("a.exr"))
        self.assertEqual(no_signature.returncode, 3)
        self.assertRegex(no_signature.stderr, "is no scene signature")
        with open(SCENE) as file:
            scene = json.load(file)
        scene["nodes"][3]["translation"][0] += 0.5
        with open(self.file("moved.gltf"), "w") as file:
            json.dump(scene, file)
        moved = run("signature", self.file("moved.gltf"), "--diff", ids, "--json", "-o", picture)
        self.assertEqual(moved.returncode, 6)
        self.assertGreater(json.loads(moved.stdout)["diff"]["nodes"], 5)

    def test_layers_come_with_the_picture_or_one_alone(self):
        for name, layers in (("a.exr", "normal,lights,crypto_node"), ("b.png", "rays"), ("c.jpg", "normal"),
                             ("m.png", "crypto_material")):
            self.assertEqual(self.render(name, "--aov", layers).returncode, 0)
        self.assertEqual(self.render("d.exr", "--aov", "albedo,node", "--multipart", "--half").returncode, 0)
        for wrong in (["e.exr", "--aov", "norml"], ["e.png", "--aov", "normal,uv"], ["e.png", "--aov", "crypto_node,uv"],
                      ["e.exr", "--multipart"], ["e.hdr", "--aov", "depth"], ["e.exr", "--aov", "uv", "--integrator", "signature"]):
            self.assertEqual(self.render(*wrong).returncode, 2, wrong)

    def test_a_tree_explains_a_pixel_in_every_form(self):
        pixel = ["tree", SCENE, "--size", "96x54", "--pixel", "39,26"]
        self.assertRegex(run(*pixel, "--explain").stdout, "^Pixel 39,26 sees glass ")
        self.assertRegex(run(*pixel).stdout, r"^pixel 39,26 of 96x54: .* rays\ncamera, weight 1: ")
        for form in ("txt", "json", "svg", "html", "glb"):
            result = run(*pixel, "-o", self.file("tree." + form))
            self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
        with open(self.file("tree.json")) as file:
            self.assertGreater(len(json.load(file)["rays"]), 5)
        self.assertEqual(run("info", self.file("tree.glb")).returncode, 0)
        for wrong in (["--pixel", "96,0"], ["--pixel", "0,54"], ["--pixel", "-1,0"], ["--pixel", "1"], ["--sample", "1"]):
            self.assertEqual(run(*pixel, *wrong).returncode, 2, wrong)
        self.assertEqual(run(*pixel, "-o", self.file("tree.pdf")).returncode, 4)

    def test_each_help_has_an_example_and_fits(self):
        for command in ([], ["render"], ["info"], ["signature"], ["tree"], ["sheet"], ["bench"], ["crosscheck"], ["make"], ["convert"]):
            text = run(*command, "--help").stdout
            self.assertIn("Example", text)
            self.assertLessEqual(max(map(len, text.splitlines())), 100)

    def test_version_names_what_the_program_stands_on(self):
        text = run("--version").stdout
        for name in ("Alhazen ", "Embree ", " lanes", "oneTBB ", "OpenImageIO "):
            self.assertIn(name, text)

    def test_clipping_is_mentioned_for_8_bits_alone(self):
        self.assertRegex(self.render("a.png", "--exposure", "6").stderr, r"^note: \d+ % .* --exposure -?[\d.]+ ")
        self.assertEqual(self.render("a.exr", "--exposure", "6").stderr, "")
        self.assertEqual(self.render("a.png").stderr, "")

    def test_views_are_those_of_a_colour_configuration_where_one_is_named(self):
        with open(self.file("c.ocio"), "w", encoding="utf-8") as file:
            file.write("ocio_profile_version: 1\nroles: {default: lin_rec709, scene_linear: lin_rec709}\n"
                       "displays:\n  Screen:\n    - !<View> {name: Black, colorspace: black}\n    - !<View> {name: Plain, colorspace: lin_rec709}\n"
                       "colorspaces:\n  - !<ColorSpace> {name: lin_rec709}\n  - !<ColorSpace>\n    name: black\n"
                       "    from_reference: !<MatrixTransform> {matrix: [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1]}\n")
        ocio = ("--ocio", self.file("c.ocio"))
        self.assertEqual(self.render("a.ppm", *ocio, "--display", "Screen", "--view", "Black").returncode, 0)
        with open(self.file("a.ppm"), "rb") as file:
            self.assertEqual(set(file.read().split(b"\n255\n", 1)[1]), {0})
        for options, message in (((*ocio, "--view", "agx"), "--view: unknown 'agx', the configuration has Black, Plain"),
                                 ((*ocio, "--display", "Wall"), "--display: unknown 'Wall', the configuration has Screen"),
                                 (("--display", "Screen"), "--display: needs --ocio"),
                                 (("--view", "agxx"), "expected one of standard, pbr-neutral, agx, aces, none; did you mean 'agx'?")):
            result = self.render("a.png", *options)
            self.assertEqual(result.returncode, 2)
            self.assertIn(message, result.stderr)
        self.assertEqual(self.render("a.exr", *ocio).returncode, 2)
        self.assertEqual(self.render("a.png", "--ocio", self.file("absent.ocio")).returncode, 3)

    def test_brdf_writes_complete_forms_by_the_name_of_the_file(self):
        for subject in ((SCENE, "--material", "glass"), ("--model", "ggx", "--anisotropy", "0.5")):
            for form in ("svg", "html", "png", "csv", "txt"):
                result = run("brdf", *subject, "-o", self.file("lobe." + form))
                self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
            xml.etree.ElementTree.parse(self.file("lobe.svg"))
            with open(self.file("lobe.csv"), encoding="utf-8") as file:
                self.assertEqual(file.readline(), "theta_i,phi_i,theta_o,phi_o,r,g,b\n")
                self.assertEqual({len(line.split(",")) for line in file}, {7})
            with open(self.file("lobe.png"), "rb") as file:
                self.assertEqual(file.read(4), b"\x89PNG")
            with open(self.file("lobe.html"), encoding="utf-8") as file:
                self.assertEqual(file.read().count('class="angle'), 18)

    def test_brdf_says_what_there_is(self):
        for options, message in (((SCENE, "--material", "coper"), "there is no material 'coper'; the scene has 0 'tiles', 1 'glass'"),
                                 ((SCENE, "--material", "coper"), "did you mean 'copper'?"),
                                 ((SCENE,), "--material: which one? the scene has 0 'tiles'"),
                                 (("--model", "fong"), "expected one of lambert, phong"),
                                 (("--model", "lambert", "--shininess", "3"), "--shininess: lambert does not take it; it takes --diffuse"),
                                 (("--model", "phong", "--shininess", "nan"), "'nan' is not a number from 0 to 1e+06"),
                                 (("--model", "phong", "--diffuse", "1,2"), "is not one number >= 0, nor R,G,B"),
                                 (("--model", "phong", "--incident", "30,90"), "angles of 0 to less than 90 degrees")):
            result = run("brdf", *options)
            self.assertEqual(result.returncode, 2)
            self.assertIn(message, result.stderr)

    def test_brdf_tells_physical_materials_from_others(self):
        physical = run("brdf", "--model", "normalised-phong", "--check")
        self.assertEqual((physical.returncode, physical.stdout.splitlines()[-1]), (0, "A physical BRDF, as far as this looks."))
        course = run("brdf", "--model", "phong", "--specular", "0.5", "--shininess", "10", "--check")
        self.assertEqual((course.returncode, course.stdout.splitlines()[-1]), (5, "No physical BRDF: it breaks energy, reciprocity."))

    def test_a_source_date_makes_the_same_bytes(self):
        for extension in ("exr", "png", "tif", "jpg", "webp", "hdr"):
            files = []
            for name, threads in (("a.", "1"), ("b.", "2")):
                self.render(name + extension, "--threads", threads, SOURCE_DATE_EPOCH="1700000000")
                with open(self.file(name + extension), "rb") as file:
                    files.append(file.read())
            self.assertEqual(files[0], files[1], extension)

    def test_a_second_signal_leaves_no_half_file(self):
        for delay in (0, 0.01, 0.1, 0.25):
            process = subprocess.Popen([PROGRAM, "render", SCENE, "-o", self.file("a.exr"), "--size", "2048x2048",
                                        "--progress", "json"], stdout=subprocess.PIPE, text=True)
            while json.loads(process.stdout.readline()).get("fraction", 0) == 0:  # loading has none
                pass
            process.send_signal(signal.SIGINT)
            time.sleep(delay)
            process.send_signal(signal.SIGINT)
            process.communicate()
            self.assertEqual(process.returncode, 130)
            self.assertLessEqual(set(os.listdir(self.folder.name)), {"a.exr"})
            if os.path.exists(self.file("a.exr")):
                with open(self.file("a.exr"), "rb") as file:
                    self.assertEqual(file.read(4), b"\x76\x2f\x31\x01")

    def test_a_closed_pipe_does_not_stop_a_render(self):
        process = subprocess.Popen([PROGRAM, "render", SCENE, "-o", self.file("a.exr"), "--size", "96x54",
                                    "--progress", "json"], stdout=subprocess.PIPE)
        process.stdout.close()
        self.assertEqual(process.wait(), 0)
        self.assertTrue(os.path.exists(self.file("a.exr")))

    def test_a_full_standard_output_is_an_error(self):
        if not os.path.exists("/dev/full"):
            self.skipTest("no /dev/full here")
        with open("/dev/full", "w", encoding="utf-8") as full:
            self.assertEqual(subprocess.run([PROGRAM, "info", SCENE], stdout=full, stderr=subprocess.DEVNULL).returncode, 4)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
