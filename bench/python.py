"""What Python adds to the command's own time: ``python bench/python.py BURGEON``, in a Python that has the package.

Both grow an oak on one thread, measure it, write it as GLB and make its report; Python hands all arrays over as well. Its time
is counted from after its imports. Processor time, so that a loaded machine matters little; both must be of one profile.
"""

import os
import resource
import statistics
import subprocess
import sys
import tempfile

RUNS = 7
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


def spent():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main(burgeon):
    mine, theirs = [], []
    with tempfile.TemporaryDirectory() as folder:
        files = [os.path.join(folder, name) for name in ("python.glb", "command.glb", "report.json")]
        for _ in range(RUNS):
            done = subprocess.run([sys.executable, "-c", GROW, files[0]], capture_output=True, text=True, check=True)
            mine.append(float(done.stdout))
            before = spent()
            asked = [burgeon, "grow", "oak", "--seed", "2", "--threads", "1", "-o", files[1], "--report", files[2], "--quiet"]
            subprocess.run(asked, check=True)
            theirs.append(spent() - before)
        with open(files[0], "rb") as a, open(files[1], "rb") as b:
            assert a.read() == b.read(), "the same file"
    for word, of in (("least", min), ("median", statistics.median)):
        print(f"{word}: Python {of(mine):.3f} s, command {of(theirs):.3f} s, {100 * (of(mine) / of(theirs) - 1):+.1f} %")


if __name__ == "__main__":
    main(*sys.argv[1:2] or ["burgeon"])
