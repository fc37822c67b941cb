"""Plants as MJCF in MuJoCo: they load, step quickly, and stay whole in gusts. Needs `mujoco` and the command line."""

import importlib.util
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

mujoco = pytest.importorskip("mujoco", reason="the package `mujoco` is not there")
ROOT = Path(__file__).resolve().parents[3]
PLANTS = {
    "oak": ["grow", "oak"],
    "rose": ["grow", "rose"],
    "tomato": ["sketch", str(ROOT / "fixtures/illustrations/01_tomato.svg")],
    "truss": ["sketch", str(ROOT / "docs/engines/tomato.svg")],
}

pytestmark = pytest.mark.simulators


@pytest.fixture(scope="module")
def written(program, tmp_path_factory):
    folder = tmp_path_factory.mktemp("robots")
    for name, asked in PLANTS.items():
        for ending in ("xml", "urdf"):
            command = [program, *asked, "-o", str(folder / f"{name}.{ending}"), "-q"]
            subprocess.run(command, check=True)
    return folder


@pytest.fixture(scope="module")
def gust():
    spec = importlib.util.spec_from_file_location("gust", ROOT / "docs/engines/gust.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("name", PLANTS)
def test_a_plant_stays_whole_in_a_minute_of_gusts(written, gust, name):
    made = gust.run(written / f"{name}.xml", seconds=60.0, speed=12.0)
    assert not made["exploded"], made
    assert 0 < made["hinges"] <= 200, made
    assert made["most_rad"] > 1e-4, "gusts move it"
    assert made["steps_a_second"] >= 1000, made


def test_a_stalk_breaks_at_its_force_and_not_before(written, gust):
    still = gust.run(written / "truss.xml", seconds=10.0, speed=0.0)
    assert still["stalks"] == 9 and still["broken"] == 0 and not still["exploded"], still
    for share, broken in [(0.5, 0), (2.0, 1)]:
        model = mujoco.MjModel.from_xml_path(str(written / "truss.xml"))
        data = mujoco.MjData(model)
        weld, limit = next(iter(gust.stalks(model).items()))
        fruit, found = model.eq_obj2id[weld], 0
        while data.time < 0.3 and not found:
            data.xfrc_applied[fruit, 2] = -share * limit
            mujoco.mj_step(model, data)
            found += gust.break_stalks(data, {weld: limit})
        assert found == broken, share


@pytest.mark.parametrize("name", PLANTS)
def test_a_plant_rests_in_the_pose_that_it_was_made_in(written, name):
    model = mujoco.MjModel.from_xml_path(str(written / f"{name}.xml"))
    data = mujoco.MjData(model)
    hinges = model.jnt_qposadr[model.jnt_type == mujoco.mjtJoint.mjJNT_HINGE]
    while data.time < 5.0:
        mujoco.mj_step(model, data)
    assert abs(data.qpos[hinges]).max() < 0.02


@pytest.mark.parametrize("name", PLANTS)
def test_both_files_have_the_same_mass_and_joints(written, name):
    model = mujoco.MjModel.from_xml_path(str(written / f"{name}.xml"))
    robot = ElementTree.parse(written / f"{name}.urdf").getroot()
    turning = [j for j in robot.iter("joint") if j.get("type") == "revolute"]
    assert len(turning) == (model.jnt_type == mujoco.mjtJoint.mjJNT_HINGE).sum()
    mass = sum(float(m.get("value")) for m in robot.iter("mass"))
    assert mass == pytest.approx(model.body_mass.sum(), rel=1e-6)
    # MuJoCo reads URDF, too.
    mujoco.MjModel.from_xml_path(str(written / f"{name}.urdf"))
