"""The figures of docs/python.md: ``python bench/python.py BURGEON``, in a Python that has the package.

- What Python adds to the command's own time: both grow an oak on one thread, measure it, write it as GLB and make its report;
  Python hands all arrays over as well, and its time is counted from after its imports. Processor time, so that a loaded
  machine matters little; both must be of one profile. NumPy's own threads, which turn in circles for a tenth of a second
  after they were started, are switched off.
- What ``import burgeon`` takes, beside Python without it.
- 1,000 hazels as labelled clouds of 20,000 points on two processes.
"""

import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time

RUNS = 7
ALONE = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
GROW = """
import sys, time, numpy as np, burgeon as bg
bg.set_threads(1)
started = time.process_time()
plant = bg.grow("oak", seed=2)
for table in (plant.nodes, plant.axes, plant.organs):
    table.to_dict()
plant.parents
for part in plant.model.parts:
    part.vertices, part.faces, part.normals, part.uvs, part.colors, part.texture, part.maps
plant.save(sys.argv[1])
plant.measures(), plant.report
print(time.process_time() - started)
"""


CLOUDS = """
import sys
from burgeon import dataset
how = {"formats": ("cloud",), "fields": {"detail": 0.3, "textures": False}, "vary": {"age": (3, 8)}}
dataset.generate("hazel", 1000, sys.argv[1], cloud={"points": 20_000}, workers=2, progress=False, **how)
"""


def waited(code, *args):
    """Seconds that a Python of its own takes for some code."""
    started = time.perf_counter()
    subprocess.run([sys.executable, "-c", code, *args], check=True)
    return time.perf_counter() - started


def spent():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main(burgeon):
    mine, theirs = [], []
    with tempfile.TemporaryDirectory() as folder:
        files = [os.path.join(folder, name) for name in ("python.glb", "command.glb", "report.json")]
        for _ in range(RUNS):
            grow = [sys.executable, "-c", GROW, files[0]]
            done = subprocess.run(grow, env=ALONE, capture_output=True, text=True, check=True)
            mine.append(float(done.stdout))
            before = spent()
            asked = [burgeon, "grow", "oak", "--seed", "2", "--threads", "1", "-o", files[1], "--report", files[2], "--quiet"]
            subprocess.run(asked, check=True)
            theirs.append(spent() - before)
        with open(files[0], "rb") as a, open(files[1], "rb") as b:
            assert a.read() == b.read(), "the same file"
    for word, of in (("least", min), ("median", statistics.median)):
        print(f"oak, {word}: Python {of(mine):.3f} s, command {of(theirs):.3f} s, {100 * (of(mine) / of(theirs) - 1):+.1f} %")
    bare, with_it = (min(waited(code) for _ in range(RUNS)) for code in ("pass", "import burgeon"))
    print(f"import burgeon: {1e3 * (with_it - bare):.0f} ms more than Python alone ({1e3 * bare:.0f} ms)")
    with tempfile.TemporaryDirectory() as folder:
        before = spent()
        took = waited(CLOUDS, os.path.join(folder, "clouds"))
        print(f"1,000 clouds: {took:.1f} s, {spent() - before:.1f} s of processor time")


if __name__ == "__main__":
    main(*sys.argv[1:2] or ["burgeon"])
