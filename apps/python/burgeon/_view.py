"""A self-contained 3-D view as HTML: it includes the meshes and the Studio's stage."""

from __future__ import annotations

import base64
import gzip
import html
import json
import struct
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, List, Protocol, Sequence

from ._given import beyond

if TYPE_CHECKING:
    import numpy as np


class _Part(Protocol):
    """A part of a model: ``burgeon.Part``, which this module must not import."""

    name: str
    material: "Dict[str, Any]"

    @property
    def maps(self) -> "Dict[str, np.ndarray]": ...

    @property
    def texture(self) -> "np.ndarray | None": ...

    @property
    def vertices(self) -> "np.ndarray": ...

    @property
    def normals(self) -> "np.ndarray": ...

    @property
    def uvs(self) -> "np.ndarray": ...

    @property
    def colors(self) -> "np.ndarray": ...

    @property
    def faces(self) -> "np.ndarray": ...


class _Model(Protocol):
    """A model: ``burgeon.Model``."""

    @property
    def name(self) -> str: ...

    @property
    def parts(self) -> "Sequence[_Part]": ...


MOST_TRIANGLES = 120_000
"""Most triangles of a view: a notebook should not exceed 5 MB."""

MOST_PIXELS = 512
"""Most pixels along a side of a texture, and twice those of its relief: a view in a notebook shows no more."""

PROGRAM = Path(__file__).with_name("_alone.js.gz")
"""The stage as one script (apps/studio-web/src/alone), which a wheel includes."""


def page(model: "_Model", height: int) -> str:
    """Returns an ``iframe`` with the view, isolated from the rest of the page."""
    if not 64 <= height <= 4096:
        raise beyond("height", height, "64 to 4096 pixels")
    program, name = _program(), html.escape(model.name)
    text = _PAGE.format(name=name, program=program, model=base64.b64encode(packed(model)).decode())
    frame = html.escape(text, quote=True)
    style = f"width:100%;height:{height}px;border:0;border-radius:6px"
    return f'<iframe srcdoc="{frame}" style="{style}" title="{name}" sandbox="allow-scripts"></iframe>'


def can_show() -> bool:
    """Returns whether the stage is there: a wheel includes it, the sources do not."""
    return PROGRAM.exists()


@cache
def _program() -> str:
    try:
        return base64.b64encode(PROGRAM.read_bytes()).decode()
    except FileNotFoundError:
        raise RuntimeError(
            "the 3-D view is not in this copy of burgeon: `cargo xtask wheel` builds it; render() makes a picture"
        ) from None


class _Bytes:
    """Bytes of several arrays, each aligned for its type."""

    def __init__(self) -> None:
        self.all = bytearray()

    def put(self, values: Any, kind: str) -> List[int]:
        """Appends values; returns their start and count."""
        import numpy as np

        array = np.ascontiguousarray(values, kind)
        self.all += bytes(-len(self.all) % 4)
        at = len(self.all)
        self.all += array.tobytes()
        return [at, int(array.size)]


class _Textures:
    """Textures of all materials, each once."""

    def __init__(self, to: _Bytes) -> None:
        self.to = to
        self.list: "List[Dict[str, Any]]" = []
        self.known: "Dict[int, Dict[str, int]]" = {}

    def view(self, texture: Any, most: int) -> "Dict[str, int] | None":
        if texture is None:
            return None
        key = texture.__array_interface__["data"][0]
        if key not in self.known:
            step = max(1, -(-max(texture.shape[:2]) // most))
            small = texture[::step, ::step]
            rows, columns, _ = small.shape
            self.known[key] = {"number": len(self.list), "width": columns, "height": rows}
            self.list.append({"width": columns, "height": rows, "pixels": self.to.put(small, "u1")})
        return self.known[key]


def packed(model: "_Model") -> bytes:
    """Returns the contents of the stage, as ``Contents`` in apps/studio-web/src/alone describes them: length, JSON, numbers; in
    gzip."""
    import numpy as np

    shown = [p for p in model.parts if len(p.faces)]
    corners = [np.array([p.vertices.min(0), p.vertices.max(0)]) for p in shown]
    to = _Bytes()
    textures = _Textures(to)
    contents = {
        "min": (np.min([c[0] for c in corners], axis=0) if corners else np.zeros(3)).tolist(),
        "max": (np.max([c[1] for c in corners], axis=0) if corners else np.ones(3)).tolist(),
        "materials": [_material(p, textures) for p in shown],
        "parts": [_part(p, row, to) for row, p in enumerate(shown)],
        "textures": textures.list,
    }
    # Offsets count from the start of the numbers, because that depends on the length of the JSON.
    text = json.dumps(contents).encode()
    text += b" " * (-len(text) % 4)
    return gzip.compress(struct.pack("<I", len(text)) + text + bytes(to.all), 6, mtime=0)


def _material(part: "_Part", textures: _Textures) -> "Dict[str, Any]":
    is_, maps = part.material, part.maps
    return {
        "name": is_["name"],
        "kind": is_["kind"],
        "color": [float(c) for c in is_["base_color"]],
        "roughness": float(is_["roughness"]),
        "translucency": float(is_["translucency"]),
        "two_sided": bool(is_["double_sided"]),
        "masked": bool(is_["cut_out"]),
        "texture": textures.view(part.texture, MOST_PIXELS),
        "normal": textures.view(maps.get("normal"), MOST_PIXELS // 2),
        "orm": textures.view(maps.get("orm"), MOST_PIXELS // 2),
    }


def _part(part: "_Part", material: int, to: _Bytes) -> "Dict[str, Any]":
    import numpy as np

    return {
        "name": part.name,
        "material": material,
        "positions": to.put(part.vertices, "<f4"),
        "normals": to.put(np.rint(127 * np.clip(part.normals, -1, 1)), "i1"),
        "uvs": to.put(part.uvs, "<f4"),
        "colors": to.put(np.rint(65535 * np.clip(part.colors, 0, 1)), "<u2"),
        "indices": to.put(part.faces, "<u4"),
    }


_PAGE = """<!doctype html><meta charset="utf-8"><title>{name}</title><style>
html,body{{margin:0;height:100%;overflow:hidden;background:#e9eef2;font:13px sans-serif}}
canvas{{display:block;touch-action:none;cursor:grab;outline-offset:-2px}}
button{{position:absolute;right:8px;top:8px;width:32px;height:32px;border:0;border-radius:16px;background:#fffc;
font-size:16px;cursor:pointer}}</style><body><script>
(async()=>{{const packed=Uint8Array.from(atob("{program}"),c=>c.charCodeAt(0));
const code=await new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
const script=document.createElement("script");script.textContent=code;document.head.append(script);
burgeonShow("{model}")}})().catch(e=>document.body.append("This browser cannot show the plant ("+e.message+"): see the \
picture instead."))
</script>"""
