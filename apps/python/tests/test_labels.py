"""Labels of pictures and clouds: cameras, masks, boxes, outlines, keypoints, and the files of other programs."""

import json
import os

import numpy as np
import pytest

import burgeon as bg
from burgeon import dataset, labels
from burgeon._outlines import joined, outlines, packed, regions, run_lengths, unpacked

PARTS = list(bg.PARTS)
SIZE = (96, 64)


def oracle():
    """COCO's own masks."""
    return pytest.importorskip("pycocotools.mask", reason="pycocotools is not installed: pip install pycocotools")


@pytest.fixture(scope="module")
def hazel():
    return bg.grow("hazel", seed=3, age=3, detail=0.2, textures=False)


@pytest.fixture(scope="module")
def shot(hazel):
    camera = bg.Camera.around(hazel, azimuth=40, elevation=15, size=SIZE)
    return labels.take(hazel, camera, supersample=1)


def patchwork(seed):
    """A picture of a few regions, some of single pixels, some that touch at corners."""
    chance = np.random.default_rng(seed)
    height, width = chance.integers(1, 24, 2)
    if seed % 2:
        return chance.integers(0, 4, (height, width))
    coarse = chance.integers(0, 5, (height // 3 + 1, width // 3 + 1))
    return np.kron(coarse, np.ones((3, 3), int))[:height, :width]


def filled(polygon, height, width):
    """Which middles of pixels lie within a polygon, by the rule of even and odd crossings."""
    x, y = np.arange(width) + 0.5, np.arange(height) + 0.5
    inside = np.zeros((height, width), bool)
    corners = np.asarray(polygon, float)
    for (x0, y0), (x1, y1) in zip(corners, np.roll(corners, -1, axis=0)):
        if y0 != y1:
            crossed = (y > min(y0, y1)) & (y <= max(y0, y1))
            at = x0 + (y - y0) * (x1 - x0) / (y1 - y0)
            inside ^= crossed[:, None] & (x[None, :] > at[:, None])
    return inside


# Cameras


def test_a_camera_projects_by_its_intrinsics():
    camera = bg.Camera((640, 480), (700, 710), (310, 250), position=(1, 2, 5), target=(1, 2, 0))
    points = [[1, 2, 0], [1.5, 2, 0], [1, 2.5, 1], [0, 1, -5], [1, 2, 6]]
    seen = camera.project(points)
    wanted = [
        [310, 250, 5],
        [310 + 700 * 0.5 / 5, 250, 5],
        [310, 250 - 710 * 0.5 / 4, 4],
        [310 - 700 / 10, 250 + 710 / 10, 10],
        [np.nan, np.nan, -1],
    ]
    np.testing.assert_allclose(seen, wanted, atol=1e-9)
    # The same by K and the pose, as other programs compute it.
    away = (camera.pose @ np.column_stack([points, np.ones(5)]).T)[:3]
    by_matrix = camera.matrix @ away
    np.testing.assert_allclose((by_matrix[:2] / by_matrix[2]).T[:4], seen[:4, :2], atol=1e-9)
    assert bg.Camera.of_dict(json.loads(json.dumps(camera.to_dict()))) == camera


def test_a_rolled_camera_has_orthonormal_axes_and_sees_its_target_at_the_principal_point():
    camera = bg.Camera(200, 300, (90, 120), position=(3, 1, -2), target=(0.2, 0.4, 0.1), up=(0.3, 1, 0.2))
    rotation = camera.pose[:3, :3]
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(rotation) == pytest.approx(1)
    np.testing.assert_allclose(camera.project([[0.2, 0.4, 0.1]])[0, :2], (90, 120), atol=1e-9)


@pytest.mark.parametrize("principal", [None, (30, 50)])
def test_pictures_show_points_where_the_camera_projects_them(hazel, principal):
    """Each pixel's point, from its depth, lies on the surface that it shows; and its normal faces the camera."""
    around = bg.Camera.around(hazel, azimuth=70, elevation=20, size=SIZE)
    camera = bg.Camera(
        SIZE, (around.fx, 1.2 * around.fy), principal, position=around.position, target=(0, 0.3, 0), up=(0.1, 1, 0)
    )
    masks = hazel.masks(camera=camera)
    rows, columns = np.nonzero(masks.part >= 0)
    assert len(rows) > 100
    depth = camera.depth_along_view(masks.depth)[rows, columns].astype(float)
    local = np.column_stack([(columns + 0.5 - camera.cx) / camera.fx, (rows + 0.5 - camera.cy) / camera.fy, np.ones(len(rows))])
    world = (local * depth[:, None]) @ camera.pose[:3, :3] + np.array(camera.position)
    np.testing.assert_allclose(camera.project(world)[:, 0], columns + 0.5, atol=1e-3)
    # For leaves: the plane of the nearest triangle that the pixel should show.
    corners, owner = [], []
    for part, label in zip(hazel.model.parts, hazel.labels()):
        corners.append(part.vertices[part.faces].astype(float))
        owner.append(label[:, 2])
    corners, owner = np.concatenate(corners), np.concatenate(owner)
    chosen = np.flatnonzero(masks.organ[rows, columns] >= 0)[::7]
    for k in chosen:
        own = corners[owner == masks.organ[rows[k], columns[k]]]
        flat = np.cross(own[:, 1] - own[:, 0], own[:, 2] - own[:, 0])
        flat /= np.maximum(np.linalg.norm(flat, axis=1, keepdims=True), 1e-30)
        off = np.abs(((world[k] - own[:, 0]) * flat).sum(axis=1))
        # Corners are rounded to 1/256 of a pixel on the picture.
        assert off.min() < 0.02 * depth[k] / camera.fx + 1e-5
    normals = masks.normal[rows, columns].astype(float)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-5)
    assert ((normals * (np.array(camera.position) - world)).sum(axis=1) > -1e-6).all()


def test_albedo_is_the_colour_of_materials_under_any_light(hazel):
    camera = bg.Camera.around(hazel, azimuth=20, elevation=15, size=SIZE)
    how = {"background": "#ff00ff", "supersample": 1}
    noon = labels.take(hazel, camera, sun=(180, 70), **how)
    evening = labels.take(hazel, camera, sun=(80, 5), sunshine=0.2, **how)
    assert (noon.albedo == evening.albedo).all() and not (noon.image == evening.image).all()
    there = noon.masks.part >= 0
    assert (noon.albedo[:, :, 3] == np.where(there, 255, 0)).all() and (noon.albedo[~there] == 0).all()
    # Without textures, wood has the base colour of one of its materials.
    parts = zip(hazel.model.parts, hazel.labels())
    linear = np.array([part.material["base_color"][:3] for part, own in parts if (own[:, 2] < 0).any() and not len(part.colors)])
    known = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055) * 255
    wood = noon.albedo[there & (noon.masks.organ < 0)][:, :3].astype(float)
    off = np.abs(wood[:, None] - known).max(axis=2).min(axis=1)
    assert len(wood) > 20 and off.max() < 1, off


def test_all_of_a_plant_is_seen_by_a_camera_around_it(hazel):
    for azimuth, elevation, size in [(0, 0, (64, 200)), (123, 60, (200, 64)), (250, -20, 100)]:
        camera = bg.Camera.around(hazel, azimuth, elevation, size, field_of_view=50)
        column, row, away = camera.project(hazel.model.vertices).T
        assert (away > 0).all() and column.min() >= 0 and row.min() >= 0
        assert column.max() <= camera.width and row.max() <= camera.height
        spans = ((column.max() - column.min()) / camera.width, (row.max() - row.min()) / camera.height)
        assert max(spans) > 0.7


@pytest.mark.parametrize(
    "how, words",
    [
        ({"size": (0, 9), "focal": 1, "target": (0, 0, 0)}, "size must be 1 to 8192"),
        ({"size": 9, "focal": 0, "target": (0, 0, 0)}, "focal"),
        ({"size": 9, "focal": 9}, "a target or a rotation"),
        ({"size": 9, "focal": 9, "target": (0, 0, 3)}, "stands on its target"),
        ({"size": 9, "focal": 9, "target": (0, -5, 3)}, "up is along the view"),
        ({"size": 9, "focal": 9, "rotation": np.ones((3, 3))}, "rotation must be"),
        ({"size": 9, "focal": 9, "target": (0, float("nan"), 0)}, "target"),
    ],
)
def test_cameras_that_see_nothing_are_told(how, words):
    size, focal = how.pop("size"), how.pop("focal")
    with pytest.raises(ValueError, match=words):
        bg.Camera(size, focal, position=(0, 0, 3), **how)


def test_a_camera_has_its_own_size_and_view(hazel, shot):
    with pytest.raises(ValueError, match="a camera has a size and a view"):
        hazel.render(64, camera=shot.camera)
    with pytest.raises(TypeError, match=r"must be a burgeon\.Camera"):
        labels.take(hazel, "front")


# Masks


@pytest.mark.parametrize("seed", range(40))
def test_outlines_fill_to_the_very_region(seed):
    picture = patchwork(seed)
    height, width = picture.shape
    rings = outlines(picture)
    assert sorted(rings) == sorted(set(picture[picture > 0].tolist()))
    for one, own in rings.items():
        assert (filled(joined(own), height, width) == (picture == one)).all()


@pytest.mark.parametrize("seed", range(40))
def test_run_lengths_areas_and_boxes_are_those_of_pycocotools(seed):
    coco = oracle()
    picture = patchwork(seed)
    height, width = picture.shape
    runs, found = run_lengths(picture), regions(picture)
    assert list(runs) == found.number.tolist()
    for one, area, box in zip(found.number.tolist(), found.area.tolist(), found.box.tolist()):
        mask = picture == one
        theirs = coco.encode(np.asfortranarray(mask.astype(np.uint8)))
        assert theirs["counts"].decode() == packed(runs[one])
        assert (unpacked(packed(runs[one])) == runs[one]).all()
        assert coco.area(theirs) == area and coco.toBbox(theirs).tolist() == box
        assert labels.encode(mask) == {"size": [height, width], "counts": packed(runs[one])}
        assert (labels.decode(labels.encode(mask)) == mask).all()


def test_masks_of_nothing_and_of_all(hazel):
    for mask in (np.zeros((3, 5), bool), np.ones((3, 5), bool), np.zeros((1, 1), bool)):
        assert (labels.decode(labels.encode(mask)) == mask).all()
    with pytest.raises(ValueError, match="not those of a mask of this size"):
        labels.decode({"size": [3, 3], "counts": packed(np.array([4]))})
    with pytest.raises(ValueError, match=r"of shape \(height, width\)"):
        labels.encode(np.zeros((2, 2, 2)))
    assert outlines(np.zeros((4, 4), int)) == {} and run_lengths(np.zeros((0, 4), int)) == {}


# Identity


def test_an_organ_has_one_number_in_pictures_and_clouds(hazel):
    known = labels.instances(hazel)
    assert len(known.part) == len(hazel.axes) + len(hazel.organs)
    cloud = hazel.cloud(3000)
    for azimuth in (0, 140):
        masks = hazel.masks(camera=bg.Camera.around(hazel, azimuth, size=SIZE))
        for own in (masks, cloud):
            there = own.instance > 0
            row = own.instance[there] - 1
            assert (known.is_organ[row] == (own.organ[there] >= 0)).all()
            assert (known.row[row] == np.where(own.organ[there] >= 0, own.organ[there], own.axis[there])).all()
            assert (known.part[row] == own.part[there]).all()
    plain = hazel.masks(SIZE)
    assert (plain.instance[plain.part < 0] == 0).all() and (plain.instance[plain.part >= 0] > 0).all()


def test_a_flower_keeps_its_numbers_from_day_to_day():
    rose = bg.bloom("rose", seed=2)
    early, late = rose.at(0), rose.at(rose.days[0])
    one, other = labels.instances(early), labels.instances(late)
    assert (one.part == other.part).all() and (one.row == other.row).all()
    assert np.abs(one.tip - other.tip).max() > 1e-3


def test_in_a_scene_each_plant_has_numbers_of_its_own(hazel):
    grass = bg.grow("grass", seed=1, age=2, detail=0.2, textures=False)
    scene = bg.scene(hazel, "rows", (1, 2), 1.2, seed=3, weeds=[grass], weed_count=2, stones=4)
    known = labels.instances(scene)
    shot = labels.take(scene, bg.Camera.around(scene, 20, 30, SIZE), supersample=1)
    masks, cloud = shot.masks, scene.cloud(4000)
    for own in (masks, cloud):
        there = own.instance > 0
        assert (known.tree[own.instance[there] - 1] == own.tree[there]).all()
        assert (known.part[own.instance[there] - 1] == own.part[there]).all()
        ground = (own.part == PARTS.index("soil")) | (own.part == PARTS.index("stone"))
        assert ground.any() and (own.instance[ground] == 0).all() and (own.tree[ground] == -1).all()
    # Instances of the second plant stand where it stands.
    second = known.tree == 1
    middle = known.insertion[second].mean(axis=0)
    assert np.abs(middle[[0, 2]] - scene.places["position"][1][[0, 2]]).max() < 0.3
    vertices = scene.model.vertices.astype(float)
    tips = known.tip[known.is_organ]
    away = [np.square(vertices - tip).sum(axis=1).min() for tip in tips[:: max(1, len(tips) // 40)]]
    assert max(away) < 1e-9


# Keypoints


def test_keypoints_of_a_bare_stem_are_its_ends():
    """A rod of known ends in front of a known camera."""
    tree = bg.grow("hazel", seed=1, age=2, detail=0.2, textures=False, bare=True)
    known = labels.instances(tree)
    camera = bg.Camera.around(tree, 0, 5, (300, 300))
    shot = labels.take(tree, camera, supersample=1)
    trunk = int(np.flatnonzero(tree.axes.order == 0)[0])
    first, end = int(tree.axes.first[trunk]), int(tree.axes.end[trunk])
    wanted = camera.project(tree.nodes.position[[first, end - 1]])[:, :2]
    row = int(np.flatnonzero(shot.instances == trunk + 1)[0])
    np.testing.assert_allclose(shot.keypoints[row, :, :2], wanted)
    np.testing.assert_allclose(known.insertion[trunk], tree.nodes.position[first])
    # A branch begins at a node of its bearer.
    borne = np.flatnonzero(tree.axes.bearer >= 0)
    away = known.insertion[borne] - tree.nodes.position[tree.axes.bearer[borne]]
    assert np.abs(away).max() < 1e-9


def test_a_keypoint_behind_a_leaf_is_hidden(hazel):
    """By rays through the triangles one by one, which the masks do not know of."""
    shot = labels.take(hazel, bg.Camera.around(hazel, azimuth=40, elevation=15, size=400), supersample=1)
    known, eye = labels.instances(hazel), np.array(shot.camera.position)
    corners = np.concatenate([p.vertices[p.faces] for p in hazel.model.parts]).astype(float)
    sides = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    agree = told = 0
    states = set()
    for one, points in list(zip(shot.instances.tolist(), shot.keypoints))[::3]:
        tip, state = known.tip[one - 1], points[1, 2]
        states.add(state)
        if state == 0 or not known.is_organ[one - 1]:
            continue
        way = tip - eye
        across = np.cross(way, sides[1])
        det = (sides[0] * across).sum(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            u = ((eye - corners[:, 0]) * across).sum(axis=1) / det
            over = np.cross(eye - corners[:, 0], sides[0])
            v, t = (way * over).sum(axis=1) / det, (sides[1] * over).sum(axis=1) / det
        hidden = ((u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0) & (t < 0.99)).any()
        told += 1
        agree += hidden == (state == labels.HIDDEN)
    assert {labels.HIDDEN, labels.VISIBLE} <= states
    # They differ where a point lies at the edge of what hides it, within a pixel.
    assert told > 40 and agree / told > 0.85


def test_points_beyond_the_picture_are_zero(hazel):
    around = bg.Camera.around(hazel, size=SIZE)
    near = bg.Camera(SIZE, 4 * around.fx, position=around.position, target=(0, 0.8, 0))
    points = labels.take(hazel, near, supersample=1).keypoints
    beyond = points[:, :, 2] == 0
    assert beyond.any() and (points[beyond] == 0).all()
    inside = points[~beyond]
    assert (inside[:, 0] >= 0).all() and (inside[:, 0] < SIZE[0]).all() and (inside[:, 1] < SIZE[1]).all()


# Files


def test_yolo_lines_are_the_masks(shot):
    """Polygons, written to six decimals and filled again, are the masks: all pixels of all instances."""
    width, height = SIZE
    lines = labels.yolo(shot, segments=True).splitlines()
    assert len(lines) == len(shot.instances)
    for line, one, part in zip(lines, shot.instances, shot.part):
        word, *shares = line.split()
        polygon = np.array(shares, float).reshape(-1, 2) * (width, height)
        assert int(word) == part and (filled(polygon, height, width) == (shot.masks.instance == one)).all()
    for line, box in zip(labels.yolo(shot).splitlines(), shot.box):
        x, y, wide, high = np.array(line.split()[1:], float) * (width, height, width, height)
        np.testing.assert_allclose([x - wide / 2, y - high / 2, wide, high], box, atol=1e-3)


def test_panoptic_pictures_have_each_pixel_once(hazel):
    scene = bg.scene(hazel, "pots", (1, 2), 1.0, seed=3, pot=(0.2, 0.3))
    shot = labels.take(scene, bg.Camera.around(scene, 20, 20, SIZE), supersample=1)
    colours, row = labels.panoptic(shot, 7, "a.png", least_pixels=4)
    numbers = colours.astype(int) @ [1, 256, 65536]
    told = {segment["id"]: segment for segment in row["segments_info"]}
    assert set(np.unique(numbers)) - {0} == set(told)
    for one, segment in told.items():
        assert (numbers == one).sum() == segment["area"]
    names = [PARTS[segment["category_id"] - 1] for segment in told.values()]
    assert names.count("soil") == 1 and names.count("pot") == 1 and names.count("leaf") > 5
    kept = (shot.masks.instance > 0) & np.isin(shot.masks.instance, list(told))
    assert (numbers[kept] == shot.masks.instance[kept]).all()


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    out = tmp_path_factory.mktemp("labelled")
    how = dict(
        formats=("labels", "cloud"),
        fields={"detail": 0.1, "textures": False, "age": 2},
        views={"count": 2, "size": SIZE, "supersample": 1},
        cloud={"points": 300},
        shard=2,
        progress=False,
        workers=1,
    )
    dataset.generate("hazel", 4, out, **how)
    return out, how


def test_pictures_of_a_data_set_are_those_of_their_cameras(made):
    out, how = made
    for plant in dataset.read(out):
        again = bg.grow("hazel", seed=plant["seed"], **how["fields"])
        about = json.loads(plant["view1.json"])
        light = {name: tuple(v) if isinstance(v, list) else v for name, v in about["light"].items()}
        shot = labels.take(again, bg.Camera.of_dict(about["camera"]), **light)
        held = plant["view1"]
        assert (shot.masks.instance == held["instance"]).all() and (shot.depth == held["depth"]).all()
        assert (shot.keypoints == held["keypoints"]).all() and (shot.instances == held["instances"]).all()
    suns = {tuple(json.loads(plant["view0.json"])["light"]["sun"]) for plant in dataset.read(out)}
    assert len(suns) == 4


def test_processes_give_the_same_labels(made, tmp_path):
    out, how = made
    dataset.generate("hazel", 4, tmp_path, **{**how, "workers": 2})
    for name in sorted(os.listdir(out)):
        assert (tmp_path / name).read_bytes() == (out / name).read_bytes()


def test_exported_masks_are_decoded_by_pycocotools_to_the_pixel(made, tmp_path):
    coco = oracle()
    from pycocotools.coco import COCO

    out = made[0]
    kinds = ("coco", "panoptic", "keypoints", "yolo", "depth", "normals", "albedo", "semantic", "instance", "cloud")
    told = dataset.export(out, tmp_path / "all", kinds, held_out=0.4, least_pixels=3)
    assert told["pictures"] == 8 and told["clouds"] == 4
    held = {f"{p['key']}-{k}.png": p[f"view{k}"] for p in dataset.read(out) for k in (0, 1)}
    seen = annotations = 0
    for split in ("train", "val"):
        table = COCO(tmp_path / "all" / "annotations" / f"keypoints_{split}.json")
        plain = json.loads((tmp_path / "all" / "annotations" / f"instances_{split}.json").read_text())
        assert len(plain["annotations"]) == len(table.anns)
        for image in table.dataset["images"]:
            seen += 1
            arrays = held.pop(image["file_name"])
            assert (tmp_path / "all" / "images" / split / image["file_name"]).is_file()
            for row in table.loadAnns(table.getAnnIds(imgIds=image["id"])):
                annotations += 1
                mask = arrays["instance"] == row["instance"]
                assert (table.annToMask(row) == mask).all()
                assert coco.area(row["segmentation"]) == row["area"] == mask.sum() >= 3
                assert coco.toBbox(row["segmentation"]).tolist() == row["bbox"]
                assert len(row["keypoints"]) == 3 * len(labels.KEYPOINTS)
                assert row["num_keypoints"] == sum(v > 0 for v in row["keypoints"][2::3])
            lines = (tmp_path / "all" / "labels" / split / image["file_name"].replace(".png", ".txt")).read_text().splitlines()
            assert len(lines) == len(table.getAnnIds(imgIds=image["id"]))
            depth = np.load(tmp_path / "all" / "depth" / split / image["file_name"].replace(".png", ".npy"))
            assert (depth == arrays["depth"]).all()
    assert seen == 8 and not held and annotations == told["annotations"] > 50


def test_exported_pictures_of_numbers_are_read_by_pillow(made, tmp_path):
    image = pytest.importorskip("PIL.Image")
    out = made[0]
    dataset.export(out, tmp_path / "all", ("semantic", "instance", "normals", "albedo", "panoptic"), held_out=0, least_pixels=1)
    for plant in dataset.read(out):
        arrays, name = plant["view0"], f"{plant['key']}-0.png"
        read = {
            kind: np.asarray(image.open(tmp_path / "all" / kind / "train" / name))
            for kind in ("semantic", "instance", "normals", "albedo")
        }
        camera = bg.Camera.of_dict(json.loads(plant["view0.json"])["camera"])
        again = bg.grow("hazel", seed=plant["seed"], **made[1]["fields"])
        assert (read["albedo"] == again.albedo(camera=camera, supersample=1)).all()
        assert (read["semantic"] == arrays["part"] + 1).all()
        assert (read["instance"].astype(int) @ [1, 256, 65536] == arrays["instance"]).all()
        segments = np.asarray(image.open(tmp_path / "all" / "annotations" / "panoptic_train" / name)).astype(int) @ [
            1,
            256,
            65536,
        ]
        assert (segments == arrays["instance"]).all()
        there = arrays["part"] >= 0
        right, down, forward = json.loads(plant["view0.json"])["camera"]["rotation"]
        seen = arrays["normal"][there].astype(float) @ np.array([right, np.negative(down), np.negative(forward)]).T
        off = np.abs(read["normals"][there] / 127.5 - 1 - seen)
        assert (read["normals"][~there] == 0).all() and off.max() < 0.005 and seen[:, 2].mean() > 0.2


def test_a_scene_is_a_data_set(tmp_path):
    how = dict(
        fields={"plant": {"detail": 0.1, "textures": False, "age": 2}, "kinds": 1, "count": [1, 2], "spacing": 1.0, "stones": 3},
        vary={"layout": ["rows", "pots", "plot"]},
        views={"size": 48, "supersample": 1},
    )
    dataset.generate("hazel", 3, tmp_path / "here", maker="scene", formats="labels", workers=1, progress=False, **how)
    words = {PARTS[part] for plant in dataset.read(tmp_path / "here") for part in np.unique(plant["view0"]["part"]) if part >= 0}
    assert {"soil", "leaf"} <= words
    told = dataset.export(tmp_path / "here", tmp_path / "there", "coco", held_out=0)
    assert told["pictures"] == 3


@pytest.mark.parametrize(
    "kinds, how, words",
    [
        (("docx",), {}, "kinds must be"),
        ((), {}, "kinds must be"),
        (("coco",), {"held_out": 2}, "held_out"),
        (("coco",), {"least_pixels": 0}, "least_pixels"),
    ],
)
def test_exports_that_cannot_be_are_told(made, tmp_path, kinds, how, words):
    with pytest.raises(ValueError, match=words):
        dataset.export(made[0], tmp_path / "there", kinds, **how)
    assert os.listdir(tmp_path) == []


def test_an_export_needs_labels_a_whole_data_set_and_a_free_folder(made, tmp_path):
    how = dict(formats="mtg", fields={"age": 2}, workers=1, progress=False)
    dataset.generate("grass", 1, tmp_path / "plain", **how)
    with pytest.raises(ValueError, match="needs a data set with the format 'labels'"):
        dataset.export(tmp_path / "plain", tmp_path / "there", "coco")
    with pytest.raises(ValueError, match=r"no manifest\.json"):
        dataset.export(tmp_path, tmp_path / "there", "coco")
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "mine.txt").write_text("mine")
    with pytest.raises(ValueError, match="there already"):
        dataset.export(made[0], tmp_path / "full", "coco")
    assert sorted(os.listdir(tmp_path)) == ["full", "plain"]


def test_an_export_that_fails_leaves_nothing(made, tmp_path, monkeypatch):
    import burgeon._export as exports

    def full(self, *path, data):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(exports._Folder, "put", full)
    with pytest.raises(OSError, match="No space left"):
        dataset.export(made[0], tmp_path / "there", "coco")
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize(
    "views, words",
    [
        ({"count": 0}, r"views\.count"),
        ({"elevation": (40, 10)}, r"views\.elevation"),
        ({"field_of_view": 500}, r"views\.field_of_view"),
        ({"fov": 3}, "views has no 'fov'"),
    ],
)
def test_views_that_cannot_be_are_told(tmp_path, views, words):
    with pytest.raises(ValueError, match=words):
        dataset.generate("hazel", 1, tmp_path, formats="labels", views=views, workers=1, progress=False)


# Scenes


def test_scenes_differ_by_seed_and_have_their_ground(hazel):
    one, same, other = (bg.scene(hazel, "rows", (2, 2), 1.0, seed=s, stones=5, relief=0.05) for s in (1, 1, 2))
    assert one.digest == same.digest != other.digest
    assert one.model.digest == same.model.digest != other.model.digest
    names = [part.name for part in one.model.parts]
    soil = one.model.parts[next(k for k, n in enumerate(names) if n.endswith("soil"))]
    assert soil.vertices[:, 1].min() >= 0 and 0.02 < soil.vertices[:, 1].max() <= 0.05
    pots = bg.scene(hazel, "pots", (1, 2), 1.0, pot=(0.1, 0.2), relief=0)
    assert pots.places["position"][:, 1].tolist() == pytest.approx([0.18, 0.18])


@pytest.mark.parametrize(
    "how, words",
    [
        ({"layout": "circle"}, "layout must be"),
        ({"count": 0}, "count must be"),
        ({"weed_count": 3}, "needs weeds"),
        ({"relief": 3}, "relief must be"),
        ({"pot": (0, 1)}, "pot must be"),
        ({"plants": []}, "a scene needs a plant"),
    ],
)
def test_scenes_that_cannot_be_are_told(hazel, how, words):
    with pytest.raises(ValueError, match=words):
        bg.scene(**{"plants": hazel, **how})


def test_the_sun_stands_where_it_is_put():
    """A wall's shadow falls away from the sun: pictures from above, with the sun in the east and in the west."""
    tree = bg.grow("hazel", seed=3, age=3, detail=0.2, textures=False)
    scene = bg.scene(tree, "rows", 1, 2.0, relief=0, jitter=0)
    camera = bg.Camera((120, 120), 200, position=(0, 6, 0), target=(0, 0, 0), up=(0, 0, -1))
    soil = scene.masks(camera=camera).part == PARTS.index("soil")
    light = {}
    for name, azimuth in (("east", 90), ("west", 270)):
        picture = scene.render(camera=camera, sun=(azimuth, 30), supersample=1)[:, :, :3].astype(float).mean(axis=2)
        sides = np.where(soil, picture, np.nan)
        light[name] = np.nanmean(sides[:, 60:]) - np.nanmean(sides[:, :60])
    # East (+x) is to the right of the picture.
    assert light["east"] > 1 and light["west"] < -1
    dim, usual = (scene.render(camera=camera, sunshine=s, skylight=s, supersample=1)[:, :, :3].mean() for s in (0.3, 1))
    assert dim < 0.7 * usual
