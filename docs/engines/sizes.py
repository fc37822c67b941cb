"""Writes four plants for each program, and prints a table of their triangles, files, materials and megabytes.

    cargo build --release -p burgeon-cli
    python docs/engines/sizes.py target/release/burgeon

It needs no packages.
"""

import json
import pathlib
import struct
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PLANTS = {
    "oak": ["grow", "oak"],
    "drawn tree": ["sketch", str(ROOT / "fixtures/sketches/gallery/oak.svg")],
    "daisy": ["sketch", str(ROOT / "fixtures/sketches/gallery/one-stroke-daisy.svg")],
    "rose": ["grow", "rose"],
}
FORMS = {
    "three": "glb",
    "blender": "glb",
    "unity": "glb",
    "unreal": "usda",
    "unreal, static": "glb",
    "godot": "glb",
    "isaac": "usda",
    "isaac, physics": "physics.usda",
    "print": "stl",
    "MuJoCo": "xml",
    "URDF": "urdf",
}


def materials(path):
    """The materials that a file has; None where its format has none."""
    if path.suffix == ".glb":
        data = path.read_bytes()
        length = struct.unpack_from("<I", data, 12)[0]
        return len(json.loads(data[20 : 20 + length]).get("materials", []))
    if path.suffix == ".usda":
        return path.read_text().count("def Material ") or None
    return None


def triangles(form, path, report):
    """The triangles of each level, by the report, or by the files whose meshes are not those of the report."""
    if form in ("MuJoCo", "URDF"):
        return [sum((mesh.stat().st_size - 84) // 50 for mesh in path.parent.glob("*.stl"))]
    if form == "isaac, physics":
        lines = [line for line in path.read_text().splitlines() if "faceVertexCounts" in line]
        return [sum(line.count(",") + 1 for line in lines)]
    return [item["counts"]["triangles"] for item in report["items"]]


def row(program, plant, form):
    """Writes a plant for a program: its triangles, files, materials and megabytes, or why it is refused."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / f"plant.{FORMS[form]}"
        engine = [] if form in ("MuJoCo", "URDF") else ["--for", form.split(",")[0]]
        command = [program, *PLANTS[plant], *engine, "-o", path, "--json"]
        made = subprocess.run(command, capture_output=True, text=True, check=False)
        if made.returncode:
            return plant, form, "refused", made.stderr.strip().splitlines()[-1]
        counts = triangles(form, path, json.loads(made.stdout))
        files = list(pathlib.Path(folder).iterdir())
        megabytes = sum(file.stat().st_size for file in files) / 1e6
        return plant, form, ", ".join(f"{n:,}" for n in counts), len(files), materials(path) or "none", f"{megabytes:.2f}"


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    print("| plant | for | triangles | files | materials | MB |\n|---|---|---|---|---|---|")
    for plant in PLANTS:
        for form in FORMS:
            print("|", " | ".join(str(cell) for cell in row(sys.argv[1], plant, form)), "|", flush=True)


if __name__ == "__main__":
    main()
