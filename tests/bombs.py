"""Small files that ask for much: each ends with status 0 or 3 and little memory. bombs.py PROGRAM [--no-memory]"""
import os
import subprocess
import sys
import tempfile

import hostile

PROGRAM = sys.argv[1]
MEASURE_MEMORY = "--no-memory" not in sys.argv  # sanitizers take memory of their own
LARGEST_FILE, MOST_MEMORY = 1 << 20, 512 << 20


def run(arguments):
    """Status, largest resident memory in bytes, seconds, the first line that it said."""
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen(arguments, stdout=subprocess.DEVNULL, stderr=said)
        _, status, usage = os.wait4(process.pid, 0)
        said.seek(0)
        lines = said.read().decode(errors="replace").splitlines()
    errors = [line for line in lines if line.startswith("error")] or lines
    seconds = usage.ru_utime + usage.ru_stime
    return os.waitstatus_to_exitcode(status), usage.ru_maxrss * 1024, seconds, (errors or [""])[0][:150]


def main():
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        file, picture = os.path.join(folder, "bomb.gltf"), os.path.join(folder, "bomb.exr")
        for bombs in (hostile.documents, hostile.numbers, hostile.streams, hostile.images):
            for name, text in bombs():
                with open(file, "w") as out:
                    out.write(text)
                assert len(text) <= LARGEST_FILE, f"{name}: {len(text)} bytes"
                for command in (["info", file], ["render", file, "-o", picture, "--size", "16x16", "--quiet"]):
                    status, memory, seconds, said = run([PROGRAM, *command])
                    good = status in (0, 3) and (memory <= MOST_MEMORY or not MEASURE_MEMORY)
                    wrong += not good
                    print(f"{'ok    ' if good else 'FAILED'} {command[0]:6} {name:50} status {status}, {memory >> 20:4} MB, "
                          f"{seconds:.1f} s of processor  {said.replace(folder, '')}", flush=True)
    print(f"{wrong} failed")
    return 1 if wrong else 0


sys.exit(main())
