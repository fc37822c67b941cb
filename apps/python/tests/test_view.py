"""The 3-D view of notebooks, in a browser without a window."""

import base64
import html
import os
import re
import shutil
import subprocess

import numpy as np
import pytest

import burgeon as bg

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome")


@pytest.fixture(scope="module")
def browser():
    found = os.environ.get("BURGEON_CHROMIUM") or next(filter(None, map(shutil.which, BROWSERS)), None)
    if not found:
        pytest.skip("the view is looked at in Chromium: install it, or name it in BURGEON_CHROMIUM")
    return found


def test_the_view_of_a_notebook_shows_the_plant(browser, tmp_path):
    image = pytest.importorskip("PIL.Image")
    plant = bg.grow("hazel", seed=3, age=6, detail=0.3)
    frame = plant._repr_html_()
    assert "http" not in frame and 'sandbox="allow-scripts"' in frame
    (tmp_path / "page.html").write_text(f"<!doctype html><body style='margin:0'>{frame}")
    shot = tmp_path / "shot.png"
    words = ["--headless=new", "--no-sandbox", "--enable-unsafe-swiftshader", "--hide-scrollbars", "--window-size=600,480"]
    words += ["--virtual-time-budget=10000", f"--user-data-dir={tmp_path / 'profile'}", f"--screenshot={shot}"]
    done = subprocess.run([browser, *words, (tmp_path / "page.html").as_uri()], check=False, capture_output=True, timeout=120)
    assert shot.exists(), done.stderr.decode()[-2000:]
    seen = np.asarray(image.open(shot).convert("RGB")).astype(int)
    red, green, blue = np.moveaxis(seen, -1, 0)
    leaves = (green > red + 10) & (green > blue + 20)
    assert leaves.mean() > 0.03, "no leaves are seen"
    # As much of the picture as the renderer fills, within reason: it stands in the middle, and not all is green.
    rows, columns = np.nonzero(leaves)
    assert 200 < columns.mean() < 400 and leaves.mean() < 0.7 and rows.max() - rows.min() > 150


def test_the_view_holds_the_mesh(small):
    text = html.unescape(small.model.to_html())
    faces = [base64.b64decode(x) for x in re.findall(r'"faces": "([^"]+)"', text)]
    assert sum(len(f) // 12 for f in faces) == small.model.triangle_count
    places = [np.frombuffer(base64.b64decode(x), "<f4") for x in re.findall(r'"positions": "([^"]+)"', text)]
    assert np.allclose(np.concatenate(places).reshape(-1, 3), small.model.vertices)
