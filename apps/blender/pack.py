"""python pack.py WHEEL OUT: the extension as a file that Blender installs, with the wheel of the core inside."""

import pathlib
import re
import sys
import zipfile

PLATFORMS = (
    ("linux.*x86_64", "linux-x64"),
    ("linux.*aarch64", "linux-arm64"),
    ("macosx.*arm64", "macos-arm64"),
    ("macosx.*x86_64", "macos-x64"),
    ("win_amd64", "windows-x64"),
    ("win_arm64", "windows-arm64"),
)
"""Platforms as wheels name them, and as Blender does."""


def pack(wheel, out):
    here = pathlib.Path(__file__).parent / "burgeon_plants"
    platform = next((name for pattern, name in PLATFORMS if re.search(pattern, wheel.name)), None)
    if platform is None:
        sys.exit(f"{wheel.name} is for no platform of Blender")
    manifest = (here / "blender_manifest.toml").read_text(encoding="utf-8")
    for name, inside in (("wheels", f"./wheels/{wheel.name}"), ("platforms", platform)):
        empty, full = f"{name} = []", f'{name} = ["{inside}"]'
        if empty not in manifest:
            sys.exit(f"blender_manifest.toml has no line `{empty}`")
        manifest = manifest.replace(empty, full)
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("blender_manifest.toml", manifest)
        for source in sorted(here.glob("*.py")):
            archive.write(source, source.name)
        archive.write(wheel, f"wheels/{wheel.name}")
    print(out)


if __name__ == "__main__":
    pack(*map(pathlib.Path, sys.argv[1:]))
