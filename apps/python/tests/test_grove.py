"""Groves: places, files, clouds, tiles of data sets."""

import json
import struct

import numpy as np
import pytest

import burgeon as bg

SMALL = {"age": 4, "detail": 0.2, "textures": False}


@pytest.fixture(scope="module")
def grove():
    return bg.grove({"hazel": 2, "birch": 1}, (12.0, 9.0), spacing=2.5, seed=7, kinds=2, **SMALL)


def test_trees_stand_apart_within_the_rectangle(grove):
    at = grove.places["position"]
    assert len(grove) == len(at) > 8
    assert (np.abs(at[:, 0]) <= 6.0).all() and (np.abs(at[:, 2]) <= 4.5).all() and (at[:, 1] == 0.0).all()
    apart = np.linalg.norm(at[:, None] - at[None], axis=2) + 99.0 * np.eye(len(at))
    assert apart.min() >= 2.5
    scale = grove.places["scale"]
    assert scale.min() >= 0.85 and scale.max() <= 1.15 and scale.std() > 0.02
    assert len({plant.name for plant in grove.plants}) == 2
    assert len({plant.digest for plant in grove.plants}) == len(grove.plants) <= 4


def test_the_same_seed_gives_the_same_grove(grove):
    again = bg.grove({"hazel": 2, "birch": 1}, (12.0, 9.0), spacing=2.5, seed=7, kinds=2, **SMALL)
    other = bg.grove({"hazel": 2, "birch": 1}, (12.0, 9.0), spacing=2.5, seed=8, kinds=2, **SMALL)
    assert again.digest == grove.digest != other.digest


def test_files_hold_all_trees_and_copies_share_meshes(grove, tmp_path):
    data = grove.to_bytes("glb")
    length = struct.unpack("<I", data[12:16])[0]
    scene = json.loads(data[20 : 20 + length])
    places = [node for node in scene["nodes"] if "translation" in node]
    assert len(places) >= len(grove) - 1
    parts = sum(len(plant.model.parts) for plant in grove.plants)
    assert len(scene["meshes"]) == parts
    grove.save(tmp_path / "grove.obj")
    assert (tmp_path / "grove.obj").stat().st_size > 1000
    per_plant = [plant.model.triangle_count for plant in grove.plants]
    assert grove.model.triangle_count == sum(per_plant[row] for row in grove.places["plant"])


def test_a_cloud_tells_which_tree_each_point_is_on(grove):
    cloud = grove.cloud(20_000, stations=3, noise=0.001)
    assert cloud.points.shape == (20_000, 3) and cloud.tree.max() < len(grove)
    assert len(np.unique(cloud.tree)) > len(grove) // 2
    # Organs are those of the point's own plant, where it stands.
    for tree in np.unique(cloud.tree)[:5]:
        plant = grove.plants[grove.places["plant"][tree]]
        own = (cloud.tree == tree) & (cloud.organ >= 0)
        yaw = np.radians(grove.places["yaw_deg"][tree])
        turn = np.array([[np.cos(yaw), 0, np.sin(yaw)], [0, 1, 0], [-np.sin(yaw), 0, np.cos(yaw)]])
        roots = plant.organs.position[cloud.organ[own]] * grove.places["scale"][tree]
        roots = roots @ turn.T + grove.places["position"][tree]
        assert np.linalg.norm(roots - cloud.points[own], axis=1).max() < 0.4
        assert (plant.organs.part[cloud.organ[own]] == cloud.part[own]).all()


def test_measures_are_sums_over_trees(grove):
    measures = grove.measures()
    assert measures["trees"] == len(grove) == len(measures["tree"])
    own = [plant.measures()["leaf_area_m2"] for plant in grove.plants]
    area = sum(own[row] * scale**2 for row, scale in zip(grove.places["plant"], grove.places["scale"]))
    assert measures["leaf_area_m2"] == pytest.approx(area)


def test_a_grove_of_ones_own_plants_and_places(small):
    places = {"position": [[0, 0, 0], [3, 0.5, 0]], "yaw_deg": [0, 90], "scale": [1, 2], "plant": [0, 0]}
    pair = bg.Grove([small], places)
    height = small.model.vertices[:, 1].max()
    assert len(pair) == 2 and pair.model.vertices[:, 1].max() == pytest.approx(2 * height + 0.5, abs=1e-3)


def test_tiles_are_plants_of_data_sets(tmp_path):
    how = {"spacing": 3.0, "area": [6.0, 6.0], "kinds": 1, **SMALL}
    made = bg.dataset.generate(
        "hazel", 3, tmp_path / "tiles", maker="grove", formats=("cloud",), fields=how,
        cloud={"points": 2000, "stations": 2}, shard=2, workers=1, progress=False,
    )  # fmt: skip
    tiles = list(bg.dataset.read(tmp_path / "tiles"))
    assert len(tiles) == made["plants"] == 3
    assert len({tile["digest"] for tile in tiles}) == 3
    assert all(tile["cloud"]["tree"].max() < tile["measures"]["trees"] for tile in tiles)
    with pytest.raises(bg.SpecError, match="formats are glb, cloud, laz, picture"):
        bg.dataset.generate("hazel", 1, tmp_path / "bad", maker="grove", formats=("mtg",))


def test_masks_say_which_tree_each_pixel_shows():
    how = dict(size=(160, 120), view="front", supersample=1)
    grove = bg.grove(["hazel", "birch"], area=9.0, spacing=3.0, kinds=1, seed=4, **SMALL)
    masks = grove.masks(**how)
    assert all(column.shape == ((120, 160, 3) if name == "normal" else (120, 160)) for name, column in masks._asdict().items())
    trees = np.unique(masks.tree[masks.tree >= 0])
    assert len(trees) >= 3 and trees.max() < len(grove)
    nothing = masks.tree < 0
    assert np.array_equal(nothing, masks.part < 0) and np.array_equal(nothing, ~np.isfinite(masks.depth))
    for tree in trees:
        plant, own = grove.plants[grove.places["plant"][tree]], masks.tree == tree
        assert masks.axis[own].max() < len(plant.axes) and masks.organ[own].max() < len(plant.organs)
        axis = masks.axis[own & (masks.organ < 0)]
        assert np.array_equal(plant.axes.part[axis], masks.part[own & (masks.organ < 0)])
    # Each tree that stands alone is where the masks of all show it.
    for tree in trees:
        one = {name: column[[tree]] for name, column in grove.places.items()}
        far = {**one, "position": one["position"] + [200.0, 0.0, 0.0]}
        both = {name: np.concatenate([one[name], far[name]]) for name in one}
        alone = bg.Grove(grove.plants, both).masks(**{**how, "size": (4096, 128)})
        assert {0, 1} == set(np.unique(alone.tree[alone.tree >= 0]))


def test_a_plant_alone_has_the_masks_of_the_plant():
    plant = bg.grow("hazel", seed=1, **SMALL)
    place = {"position": [[0, 0, 0]], "yaw_deg": [0], "scale": [1], "plant": [0]}
    how = dict(size=(96, 96), view="front", supersample=1)
    one, own = bg.Grove([plant], place).masks(**how), plant.masks(**how)
    assert all(np.array_equal(getattr(one, name), getattr(own, name)) for name in own._fields)
    assert np.array_equal(one.tree, np.where(own.part < 0, -1, 0)) and (one.tree == 0).any()


def test_tiles_have_pictures_with_a_mask_for_each_tree(tmp_path):
    how = {"spacing": 3.0, "area": [6.0, 6.0], "kinds": 1, **SMALL}
    bg.dataset.generate(
        "hazel", 1, tmp_path / "tiles", maker="grove", formats=("picture",), fields=how,
        picture={"size": 96, "supersample": 1}, workers=1, progress=False,
    )  # fmt: skip
    (tile,) = bg.dataset.read(tmp_path / "tiles")
    assert tile["png"].startswith(b"\x89PNG") and sorted(tile["masks"]) == [
        "axis", "depth", "instance", "normal", "organ", "part", "tree",
    ]  # fmt: skip
    assert tile["masks"]["tree"].shape == (96, 96) and tile["masks"]["tree"].max() < tile["measures"]["trees"]


@pytest.mark.parametrize(
    "how, words",
    [
        ({"spacing": 0}, "spacing must be 0.05 to 100"),
        ({"area": (10, -1)}, r"area\[1\] must be 0.1 to 1000"),
        ({"area": (1000, 1000), "spacing": 1.0}, "at most 2000 plants"),
        ({"kinds": 0}, "kinds must be 1 to 100, not 0"),
        ({"kinds": 1.5}, "kinds must be a whole number, 1 to 100, not 1.5"),
        ({"vary": 2}, "vary must be 0 to 0.9"),
        ({"vary": float("nan")}, "vary must be"),
        ({"species": {"oak": -1}}, "share of 'oak'"),
        ({"species": "oka"}, "there is no preset"),
    ],
)
def test_what_is_wrong_is_told(how, words):
    with pytest.raises(ValueError, match=words):
        bg.grove(**how)


def test_places_of_the_wrong_shape_are_told(small):
    good = {"position": [[0, 0, 0]], "yaw_deg": [0], "scale": [1], "plant": [0]}
    for name, value, words in [
        ("position", [[0, 0]], "shape"),
        ("scale", [0], "scale above 0"),
        ("plant", [1], "a plant that is there"),
        ("plant", [-1], "rows of the plants"),
        ("yaw_deg", [float("inf")], "finite"),
    ]:
        with pytest.raises(ValueError, match=words):
            bg.Grove([small], {**good, name: value})
