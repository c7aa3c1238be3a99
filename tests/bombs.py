"""Small files that ask for much: each ends with status 0 or 3, in little time of the processor and little memory.

    bombs.py PROGRAM [--no-limits]"""
import concurrent.futures
import os
import subprocess
import sys
import tempfile

import hostile

PROGRAM = sys.argv[1]
LIMITED = "--no-limits" not in sys.argv  # sanitizers take time and memory of their own
LARGEST_FILE, MOST_MEMORY, MOST_SECONDS = 1 << 20, 512 << 20, 2
PATIENCE = 3  # a processor that others share, or an old one, takes so many times as long
LIMIT = ["sh", "-c", f'ulimit -t {PATIENCE * MOST_SECONDS} && exec "$@"', "sh"] if LIMITED else []  # the kernel ends what takes longer


def run(arguments):
    """Status, largest resident memory in bytes, seconds of the processor, the first line that it said."""
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen([*LIMIT, PROGRAM, *arguments], stdout=subprocess.DEVNULL, stderr=said)
        _, status, usage = os.wait4(process.pid, 0)
        said.seek(0)
        lines = said.read().decode(errors="replace").splitlines()
    errors = [line for line in lines if line.startswith("error")] or lines
    seconds = usage.ru_utime + usage.ru_stime
    return os.waitstatus_to_exitcode(status), usage.ru_maxrss * 1024, seconds, (errors or [""])[0][:150]


def try_bomb(folder, name, text, decoded):
    """What is said of a bomb, and whether it was survived. `info` looks at all but the images, which need a picture."""
    number = name.replace("/", " ").replace(" ", "-")
    file, picture = os.path.join(folder, number + ".gltf"), os.path.join(folder, number + ".exr")
    with open(file, "w") as out:
        out.write(text)
    assert len(text) <= LARGEST_FILE, f"{name}: {len(text)} bytes"
    info, render = ["info", file], ["render", file, "-o", picture, "--size", "16x16", "--quiet"]
    lines, survived = [], True
    for command in ([render] if decoded else [info, render]):
        status, memory, seconds, said = run(command)
        good = status in (0, 3) and (memory <= MOST_MEMORY or not LIMITED)
        survived = survived and good
        lines.append(f"{'ok    ' if good else 'FAILED'} {command[0]:6} {name:50} status {status}, {memory >> 20:4} MB, "
                     f"{seconds:.1f} s of processor  {said.replace(folder, '')}")
        if status != 0:
            break  # what `info` refuses, `render` does too
    os.remove(file)
    return "\n".join(lines), survived


def main():
    bombs = [(name, text, kind == hostile.images) for kind in (hostile.documents, hostile.numbers, hostile.streams, hostile.images)
             for name, text in kind()]
    wrong = 0
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for lines, survived in pool.map(lambda bomb: try_bomb(folder, *bomb), bombs):
            wrong += not survived
            print(lines, flush=True)
    print(f"{wrong} failed")
    return 1 if wrong else 0


sys.exit(main())
