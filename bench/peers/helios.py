"""Runs in an environment where pyhelios3d is installed: the almond of its plant library at one year."""

import json
import time

from pyhelios import Context, PlantArchitecture
from pyhelios.types import vec3

times, triangles = [], 0
for _ in range(3):
    with Context() as context:
        with PlantArchitecture(context) as plants:
            plants.disableMessages()
            plants.loadPlantModelFromLibrary("almond")
            started = time.perf_counter()
            plants.buildPlantInstanceFromLibrary(vec3(0.0, 0.0, 0.0), 365.0)
            times.append((time.perf_counter() - started) * 1e3)
            triangles = context.getPrimitiveCount()
times.sort()
# Its progress bar leaves the line open.
print()
print(json.dumps({"best_ms": times[0], "median_ms": times[len(times) // 2], "triangles": triangles}))
