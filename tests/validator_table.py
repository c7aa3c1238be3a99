"""Compares what `alhazen` says of models with what Khronos's gltf-validator says. A developer's tool:

    npm install --prefix /tmp/validator gltf-validator
    validator_table.py PROGRAM MODELS /tmp/validator [--all]

Prints how many models both take, both refuse, and so on, and each that the validator refuses and the program takes without
a word; with --all every one where they differ. Status 1 where there is such a silent one, 77 where node or gltf-validator is missing."""
import collections
import json
import os
import shutil
import subprocess
import sys
import tempfile

VALIDATE = """
const fs = require('fs'), path = require('path'), validator = require(process.argv[1] + '/node_modules/gltf-validator');
(async () => {
  for (const file of fs.readFileSync(0, 'utf8').split('\\n').filter(Boolean)) {
    const found = {file, errors: []};
    try {
      const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {
        uri: file, maxIssues: 100000,
        externalResourceFunction: async uri => new Uint8Array(fs.readFileSync(path.join(path.dirname(file), decodeURIComponent(uri))))});
      found.errors = report.issues.messages.filter(m => m.severity == 0).map(m => [m.code, m.pointer || '', m.message]);
    } catch (error) { found.errors = [['NOT_GLTF', '', String(error)]]; }
    console.log(JSON.stringify(found));
  }
})();
"""


def models(folder):
    for where, _, names in sorted(os.walk(folder)):
        yield from (os.path.join(where, name) for name in sorted(names) if name.endswith((".gltf", ".glb")))


def said_by(program, file, picture):
    """The status, and warnings and errors, of `info`; where that takes the file, of a small picture."""
    for command in (["info", file], ["render", file, "-o", picture, "--size", "16x16", "--quiet"]):
        result = subprocess.run([program, *command], capture_output=True, text=True, errors="replace", timeout=300)
        if result.returncode != 0 or (command[0] == "info" and "warning" in result.stderr):
            break
    return result.returncode, result.stderr.strip().splitlines()


def classify(errors, status, said):
    if not errors:
        return "both take it" if status == 0 else "only we refuse it"
    if status != 0:
        return "both refuse it"
    return "it refuses, we warn" if said else "it refuses, we are silent"


def main():
    program, folder, packages = sys.argv[1:4]
    if not shutil.which("node") or not os.path.isdir(os.path.join(packages, "node_modules", "gltf-validator")):
        print("skipped: node or gltf-validator is missing")
        return 77
    files = list(models(folder))
    reports = subprocess.run(["node", "-e", VALIDATE, packages], input="\n".join(files), capture_output=True, text=True, check=True)
    table = collections.Counter()
    with tempfile.TemporaryDirectory() as work:
        for report in map(json.loads, reports.stdout.splitlines()):
            status, said = said_by(program, report["file"], os.path.join(work, "picture.exr"))
            kind = classify(report["errors"], status, said)
            table[kind] += 1
            if kind == "it refuses, we are silent" or ("--all" in sys.argv and kind != "both take it"):
                print(f"{kind}: {os.path.relpath(report['file'], folder)}")
                print("".join(f"    validator: {' '.join(error)[:200]}\n" for error in report["errors"][:4]), end="")
                print("".join(f"    alhazen: {line[:200]}\n" for line in said[:4]), end="")
    for kind, count in sorted(table.items()):
        print(f"{count:5} {kind}")
    return 1 if table["it refuses, we are silent"] else 0


sys.exit(main())
