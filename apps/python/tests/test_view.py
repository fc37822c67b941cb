"""The 3-D view of notebooks, in a browser without a window."""

import gzip
import html
import http.server
import json
import os
import shutil
import struct
import subprocess
import threading
import time

import numpy as np
import pytest

import burgeon as bg
from burgeon._view import packed

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome")


@pytest.fixture(scope="module")
def browser():
    found = os.environ.get("BURGEON_CHROMIUM") or next(filter(None, map(shutil.which, BROWSERS)), None)
    if not found:
        pytest.skip("the view is looked at in Chromium: install it, or name it in BURGEON_CHROMIUM")
    return found


class Later(http.server.BaseHTTPRequestHandler):
    """A picture that takes its time: a page is there when all of its pictures are."""

    def do_GET(self):
        time.sleep(8)
        self.send_error(404)

    def log_message(self, *_):
        pass


@pytest.fixture
def later():
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Later)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_address[1]}/"
    server.shutdown()


def test_the_view_of_a_notebook_shows_the_plant(browser, later, tmp_path):
    image = pytest.importorskip("PIL.Image")
    plant = bg.grow("hazel", seed=3, age=6, detail=0.3)
    frame = plant._repr_html_()
    assert "://" not in frame and 'sandbox="allow-scripts"' in frame
    page = f"<!doctype html><body style='margin:0'>{frame}<img src='{later}' hidden>"
    (tmp_path / "page.html").write_text(page)
    shot = tmp_path / "shot.png"
    words = ["--headless=new", "--no-sandbox", "--enable-unsafe-swiftshader", "--hide-scrollbars", "--window-size=600,480"]
    words += [f"--user-data-dir={tmp_path / 'profile'}", f"--screenshot={shot}"]
    done = subprocess.run([browser, *words, (tmp_path / "page.html").as_uri()], check=False, capture_output=True, timeout=120)
    assert shot.exists(), done.stderr.decode()[-2000:]
    seen = np.asarray(image.open(shot).convert("RGB")).astype(int)
    red, green, blue = np.moveaxis(seen, -1, 0)
    leaves = (green > red + 10) & (green > blue + 20)
    assert leaves.mean() > 0.03, "no leaves are seen"
    # As much of the picture as the stage gives a plant: it stands in the middle, and not all is green.
    rows, columns = np.nonzero(leaves)
    assert 200 < columns.mean() < 400 and leaves.mean() < 0.7 and rows.max() - rows.min() > 150
    # It stands on a ground, below a sky, and throws a shadow.
    assert blue[:20].mean() > red[:20].mean() + 4
    ground = seen[-120:].mean(axis=2)
    assert ground.min() < 0.8 * np.median(ground)


def test_the_view_holds_the_mesh(small):
    model = small.model
    raw = gzip.decompress(packed(model))
    (length,) = struct.unpack("<I", raw[:4])
    contents, numbers = json.loads(raw[4 : 4 + length]), raw[4 + length :]
    assert (4 + length) % 4 == 0 and len(contents["parts"]) == len(model.parts)

    def rows(of, kind, width):
        at, count = of
        assert at % np.dtype(kind).itemsize == 0, "where its type may begin"
        return np.frombuffer(numbers, kind, count, at).reshape(-1, width)

    for part, held in zip(model.parts, contents["parts"]):
        assert np.array_equal(rows(held["indices"], "<u4", 3), part.faces)
        assert np.array_equal(rows(held["positions"], "<f4", 3), part.vertices)
        assert np.allclose(rows(held["normals"], "i1", 3) / 127, part.normals, atol=0.005)
        assert np.allclose(rows(held["colors"], "<u2", 3) / 65535, part.colors, atol=1e-4)
        look = contents["materials"][held["material"]]
        assert look["name"] == part.material["name"] and (look["texture"] is None) == (part.texture is None)
        if part.texture is not None:
            view = look["texture"]
            assert max(view["width"], view["height"]) <= 512
            held = contents["textures"][view["number"]]
            assert rows(held["pixels"], "u1", 4).shape[0] == view["width"] * view["height"]


def test_without_the_stage_there_is_a_picture(small, monkeypatch, tmp_path):
    from burgeon import _view

    monkeypatch.setattr(_view, "PROGRAM", tmp_path / "none.js.gz")
    _view._program.cache_clear()
    assert small._repr_html_() is None and small.model._repr_html_() is None
    with pytest.raises(RuntimeError, match="cargo xtask wheel"):
        small.to_html()
    _view._program.cache_clear()
    assert small._repr_png_().startswith(b"\x89PNG")


def test_names_of_plants_are_no_markup():
    plant = bg.grow("hazel", seed=1, age=2, detail=0.2, name='"><script>alert(1)</script>')
    frame = plant.to_html()
    assert "<script" not in frame and 'srcdoc="' in frame
    inner = html.unescape(frame.split('srcdoc="')[1].split('"')[0])
    assert "<script>alert" not in inner and "&lt;script&gt;alert(1)" in inner
