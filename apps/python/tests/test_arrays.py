"""Tables and meshes: what they hold, and that nothing is copied."""

import gc
import sys
import types

import numpy as np
import pytest

import burgeon as bg


def address(array):
    return array.__array_interface__["data"][0]


def test_arrays_are_the_memory_of_the_core(small):
    part = small.model.parts[0]
    for read in (lambda: part.vertices, lambda: part.faces, lambda: part.normals):
        first, again = read(), read()
        assert address(first) == address(again) and first is not again
        assert not first.flags["W"] and not first.flags.owndata
    raw = small._raw
    for name in ("node_position", "node_radius", "node_axis"):
        assert address(np.asarray(raw.column(name))) == address(np.asarray(raw.column(name)))
    with pytest.raises(ValueError):
        small.nodes.radius[0] = 1.0


def test_arrays_keep_what_they_look_at():
    plant = bg.grow("hazel", seed=1, age=3, detail=0.2)
    position, sum_ = plant.nodes.position, plant.nodes.position.sum()
    vertices = plant.model.parts[0].vertices
    before = vertices.copy()
    del plant
    gc.collect()
    others = [bg.grow("hazel", seed=k, age=3, detail=0.2) for k in range(3)]
    assert position.sum() == sum_ and (vertices == before).all() and len(others) == 3


def test_tables_fit_together(small):
    nodes, axes, organs = small.nodes, small.axes, small.organs
    assert nodes.position.shape == (len(nodes), 3) and nodes.radius.min() >= 0
    assert (nodes.axis[axes.first] == np.arange(len(axes))).all()
    assert axes.end[-1] == len(nodes) and (axes.first[1:] == axes.end[:-1]).all()
    borne = axes.bearer >= 0
    assert (nodes.axis[axes.bearer[borne]] == axes.parent[borne]).all()
    assert (axes.order[borne] == axes.order[axes.parent[borne]] + 1).all() and (axes.order[~borne] == 0).all()
    parents = small.parents
    assert (parents[axes.first] == axes.bearer).all() and (parents < np.arange(len(nodes))).all()
    assert np.allclose(np.linalg.norm(organs.along, axis=1), 1) and (organs.scale > 0).all()
    assert set(np.unique(organs.part)) <= set(range(5, len(bg.PARTS)))
    assert set(organs.to_dict()) >= {"part", "position_x", "normal_z", "scale"}
    length = np.linalg.norm(np.diff(nodes.position, axis=0), axis=1)[np.diff(nodes.axis) == 0].sum()
    wood = [bg.PARTS.index(p) for p in ("petiole", "root", "stub")]
    if not np.isin(axes.part, wood).any():
        assert np.isclose(length, small.measures()["length_m"])


def test_meshes_are_whole(small):
    model = small.model
    assert model.faces.max() < len(model.vertices) == len(model.normals) == len(model.colors)
    assert np.allclose(np.linalg.norm(model.normals, axis=1), 1, atol=1e-4)
    assert model.triangle_count == len(model.faces) == small.report["counts"]["triangles"]
    coarse = small.level(2)
    assert coarse.triangle_count < model.triangle_count
    with pytest.raises(ValueError, match="level must be 0 to 6, not 9"):
        small.level(9)


def test_labels_say_what_triangles_lie_on(small):
    for part, labels in zip(small.model.parts, small.labels()):
        assert labels.shape == (len(part.faces), 3)
        kinds = {bg.PARTS[k] for k in np.unique(labels[:, 0])}
        assert kinds <= ({"leaf"} if part.name == "leaves" else {"branch", "twig", "stem"}), part.name
        leaves = labels[labels[:, 2] >= 0]
        assert (small.organs.part[leaves[:, 2]] == leaves[:, 0]).all()
    # A leaf's triangles lie at the leaf.
    part = next(p for p in small.model.parts if p.name == "leaves")
    rows = small.labels()[small.model.parts.index(part)]
    middle = part.vertices[part.faces].mean(axis=1)
    away = np.linalg.norm(middle - small.organs.position[rows[:, 2]], axis=1)
    assert away.max() < 0.3 and len(np.unique(rows[:, 2])) == len(small.organs)


def test_flowers_have_labels_too():
    rose = bg.bloom("rose", 5.0)
    parts = {bg.PARTS[k] for rows in rose.labels() for k in np.unique(rows[:, 0])}
    assert {"petal", "stem"} <= parts
    assert {bg.PARTS[k] for k in np.unique(rose.cloud(2000).part)} >= {"petal"}


def test_clouds_lie_on_the_surface(small):
    cloud = small.cloud(4000, seed=5)
    assert cloud.points.shape == (4000, 3) and cloud.part.shape == (4000,)
    low, high = small.model.vertices.min(0), small.model.vertices.max(0)
    assert (cloud.points >= low - 1e-4).all() and (cloud.points <= high + 1e-4).all()
    again, other = small.cloud(4000, seed=5), small.cloud(4000, seed=6)
    assert (cloud.points == again.points).all() and not (cloud.points == other.points).all()
    on_leaves = cloud.organ >= 0
    assert (small.organs.part[cloud.organ[on_leaves]] == cloud.part[on_leaves]).all()
    assert set(np.unique(cloud.station)) == {0, 1, 2, 3}
    assert (cloud.order == np.where(cloud.axis >= 0, small.axes.order[cloud.axis], 0)).all()


def test_what_is_hidden_is_not_seen(small):
    """From above, few points lie on wood; from one side, none face away."""
    one = small.cloud(3000, stations=1, elevation=0)
    assert (one.normals[:, 2] > -0.2).mean() > 0.95
    noisy = small.cloud(3000, stations=1, elevation=0, noise=0.05)
    off = np.linalg.norm(noisy.points - one.points, axis=1)
    assert 0.04 < np.sqrt((off**2).mean()) < 0.06


def test_beams_that_an_edge_splits_say_so_and_keep_a_label_of_what_they_met(small):
    """Their points lie off the surface, which the points of lines show."""
    line, wide = small.cloud(3000, seed=5), small.cloud(3000, seed=5, beam=4.0, pulse=0.5)
    assert (line.share == 1).all() and (line.echoes == 1).all() and (line.time == 0).all()
    mixed = wide.share < 1
    assert 0.1 < mixed.mean() < 0.95 and (wide.share > 0).all() and (wide.echo < wide.echoes).all()
    surface = small.cloud(30_000, seed=5).points

    def away(points):
        return np.median([np.sqrt(np.square(surface - p).sum(axis=1).min()) for p in points[::5]])

    assert away(wide.points[mixed]) > 1.5 * away(wide.points[~mixed])
    organs = wide.organ >= 0
    assert (small.organs.part[wide.organ[organs]] == wide.part[organs]).all() and organs.any() and not organs.all()
    assert (wide.instance == np.where(organs, wide.organ + 1 + len(small.axes), wide.axis + 1)).all()
    # A short pulse tells more surfaces apart.
    short = small.cloud(3000, seed=5, beam=4.0, pulse=0.02)
    assert (short.share < 1).mean() < mixed.mean() and short.echoes.max() > wide.echoes.max()


def test_a_scanner_moves_along_its_path(small):
    low, high = small.model.vertices.min(0), small.model.vertices.max(0)
    path = np.array([(low[0] - 1, 0.5, high[2] + 2), (high[0] + 1, 0.5, high[2] + 2), (high[0] + 1, 3, high[2] + 2)])
    cloud = small.cloud(2000, path=path, noise=0.0)
    legs = np.linalg.norm(np.diff(path, axis=0), axis=1)
    ends = np.concatenate([[0], np.cumsum(legs)]) / legs.sum()
    at = np.stack([np.interp(cloud.time, ends, path[:, k]) for k in range(3)], axis=1)
    assert (np.diff(cloud.time) >= 0).all() and set(cloud.station) == {0, 1}
    np.testing.assert_allclose(np.linalg.norm(cloud.points - at, axis=1), cloud.distance, rtol=1e-5)
    # Beams lie in planes across the path.
    along = np.diff(path, axis=0)[cloud.station] / legs[cloud.station][:, None]
    assert np.abs(((cloud.points - at) * along).sum(axis=1)).max() < 1e-5
    assert (cloud.points == small.cloud(2000, path=path.tolist()).points).all()
    grove = bg.Grove([small], {"position": [(0, 0, 0), (2, 0, 0)], "yaw_deg": [0, 90], "scale": [1, 1], "plant": [0, 0]})
    assert set(grove.cloud(500, path=[(-5, 1, 4), (7, 1, 4)], beam=1.0).tree) == {0, 1}


def test_clouds_are_saved_whole_and_alike(small, tmp_path):
    cloud = small.cloud(500)
    cloud.save(tmp_path / "a.npz")
    assert cloud.to_bytes() == (tmp_path / "a.npz").read_bytes()
    with np.load(tmp_path / "a.npz") as back:
        assert (back["points"] == cloud.points).all() and (back["part"] == cloud.part).all()


def test_pictures_and_masks_show_the_same(small):
    picture = small.render((160, 120), background="transparent", shadow=False)
    masks = small.masks((160, 120))
    assert picture.shape == (120, 160, 4) and masks.part.shape == (120, 160)
    solid, seen = picture[..., 3] == 255, masks.part >= 0
    assert seen.sum() > 200 and seen[solid].mean() > 0.99
    # The middle of a pixel may meet a sliver that lies between the samples of the picture.
    assert seen[picture[..., 3] == 0].sum() < 0.01 * seen.sum()
    assert np.isfinite(masks.depth[seen]).all() and np.isinf(masks.depth[~seen]).all()
    assert small._repr_png_().startswith(b"\x89PNG")
    html = small._repr_html_()
    assert html.startswith("<iframe") and "://" not in html


def test_files_are_those_of_the_model(small, tmp_path):
    for extension in ("glb", "obj", "ply", "stl", "usda", "usdz"):
        small.save(tmp_path / f"plant.{extension}")
    assert (tmp_path / "plant.mtl").exists() and (tmp_path / "plant.glb").read_bytes()[:4] == b"glTF"
    small.save(tmp_path / "plant.mtg")
    small.save(tmp_path / "plant.qsm.csv")
    text = small.to_bytes("mtg").decode()
    assert text == (tmp_path / "plant.mtg").read_text() and "/P1" in text
    assert not [p for p in tmp_path.iterdir() if p.name.endswith(".draft")]


def test_structure_is_what_openalea_reads_where_it_is_installed(small, monkeypatch):
    class MTG:
        def __init__(self, text):
            self.text = text

    folder = types.ModuleType("openalea.mtg.io")
    folder.read_mtg = MTG
    for name in ("openalea", "openalea.mtg"):
        monkeypatch.setitem(sys.modules, name, types.ModuleType(name))
    monkeypatch.setitem(sys.modules, "openalea.mtg.io", folder)
    read = small.mtg()
    assert isinstance(read, MTG) and read.text.encode() == small.to_bytes("mtg")
    assert small.mtg(unit="cm").text != read.text


def test_structure_is_an_mtg_or_its_text(small):
    try:
        from openalea.mtg import MTG
    except ImportError:
        assert small.mtg().encode() == small.to_bytes("mtg")
    else:
        assert isinstance(small.mtg(), MTG)


def test_trimesh_reads_it():
    trimesh = pytest.importorskip("trimesh")
    tree = bg.grow("hazel", seed=3, age=4, detail=0.2)
    scene = tree.model.to_trimesh()
    assert set(scene.geometry) == {p.name for p in tree.model.parts}
    mine, theirs = tree.model, scene.geometry
    for part in mine.parts:
        assert np.allclose(theirs[part.name].vertices, part.vertices)
        assert (theirs[part.name].faces == part.faces).all()
    loaded = trimesh.load(trimesh.util.wrap_as_stream(tree.to_bytes("glb")), file_type="glb", process=False)
    assert sum(len(g.faces) for g in loaded.geometry.values()) == mine.triangle_count


def test_areas_lengths_and_angles_add_up_to_the_measures(small):
    measured = small.measures()
    leaf = small.organs.part == bg.PARTS.index("leaf")
    assert small.organs.area[leaf].sum() == pytest.approx(measured["leaf_area_m2"])
    wood = np.isin(small.axes.part, [bg.PARTS.index(part) for part in ("branch", "twig", "stem")])
    assert small.axes.length[wood].sum() == pytest.approx(measured["length_m"])
    standing = small.axes.order == 0
    assert np.isnan(small.axes.angle[standing]).all() and (small.axes.angle[~standing] >= 0).all()
    layers = small.leaf_area_by_layer(0.25)
    assert layers.sum() == pytest.approx(measured["leaf_area_m2"]) and 1 < len(layers) <= 4 * measured["height_m"] + 2
    with pytest.raises(ValueError, match="layer must be"):
        small.leaf_area_by_layer(0)
