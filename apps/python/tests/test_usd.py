"""USD files by USD's own library: its validators find nothing, and it reads what was written. Needs `usd-core`."""

import subprocess

import pytest

Usd = pytest.importorskip("pxr.Usd", reason="the package `usd-core` is not there")
from pxr import UsdGeom, UsdPhysics, UsdSkel, UsdValidation  # noqa: E402

pytestmark = pytest.mark.simulators

SMALL = ("grow", "hazel", "--age", "4")
FILES = {
    "plain.usda": ("--for", "isaac", "--textures", "64"),
    "plain.usdz": ("--for", "isaac", "--textures", "64"),
    "hazel.physics.usda": ("--for", "isaac"),
    "assembly.usda": ("--for", "unreal", "--textures", "64"),
}


@pytest.fixture(scope="module")
def written(program, tmp_path_factory):
    folder = tmp_path_factory.mktemp("usd")
    for name, words in FILES.items():
        subprocess.run([program, *SMALL, *words, "-o", folder / name, "-q"], check=True)
    subprocess.run([program, *SMALL, "-o", folder / "hazel.xml", "-q"], check=True)
    return folder


@pytest.mark.parametrize("name", FILES)
def test_validators_find_nothing(written, name):
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert len(validators) >= 20
    found = UsdValidation.ValidationContext(validators).Validate(Usd.Stage.Open(str(written / name)))
    assert not found, [f"{e.GetName()}: {e.GetMessage()}" for e in found]


def test_bodies_hang_together_by_joints_with_springs(written):
    stage = Usd.Stage.Open(str(written / "hazel.physics.usda"))
    assert UsdGeom.GetStageUpAxis(stage) == "Z" and UsdGeom.GetStageMetersPerUnit(stage) == 1
    assert UsdPhysics.GetStageKilogramsPerUnit(stage) == 1
    prims = list(stage.Traverse())
    bodies = {p.GetPath() for p in prims if p.HasAPI(UsdPhysics.RigidBodyAPI)}
    joints = [UsdPhysics.Joint(p) for p in prims if p.IsA(UsdPhysics.Joint)]
    assert len(joints) == len(bodies) > 2
    for joint in joints:
        ends = joint.GetBody0Rel().GetTargets() + joint.GetBody1Rel().GetTargets()
        assert set(ends) <= bodies and len(ends) in (1, 2)
    bent = [j.GetPrim() for j in joints if j.GetPrim().GetTypeName() == "PhysicsJoint"]
    assert bent
    for prim in bent:
        for axis in ("rotY", "rotZ"):
            drive = UsdPhysics.DriveAPI(prim, axis)
            assert drive.GetStiffnessAttr().Get() > 0 and drive.GetDampingAttr().Get() > 0
            assert UsdPhysics.LimitAPI(prim, axis).GetLowAttr().Get() == pytest.approx(-90, abs=0.1)
        locked = UsdPhysics.LimitAPI(prim, "transX")
        assert locked.GetLowAttr().Get() > locked.GetHighAttr().Get()
    assert any(p.IsA(UsdGeom.Capsule) and p.HasAPI(UsdPhysics.CollisionAPI) for p in prims)


def test_bodies_of_usd_weigh_and_turn_as_those_of_mujoco(written):
    mujoco = pytest.importorskip("mujoco", reason="the package `mujoco` is not there")
    import numpy as np

    model = mujoco.MjModel.from_xml_path(str(written / "hazel.xml"))
    stage = Usd.Stage.Open(str(written / "hazel.physics.usda"))
    root = stage.GetDefaultPrim()
    seen = 0
    for row in range(1, model.nbody):
        body = root.GetChild(model.body(row).name)
        mass = UsdPhysics.MassAPI(body)
        assert mass.GetMassAttr().Get() == pytest.approx(model.body_mass[row], rel=1e-6)
        moments = sorted(mass.GetDiagonalInertiaAttr().Get())
        assert moments == pytest.approx(sorted(model.body_inertia[row]), rel=1e-3, abs=1e-12)
        assert np.allclose(mass.GetCenterOfMassAttr().Get(), model.body_ipos[row], atol=1e-6)
        seen += 1
    assert seen > 2


def test_an_assembly_bends_by_its_skeleton_and_bears_leaves(written):
    stage = Usd.Stage.Open(str(written / "assembly.usda"))
    assert UsdGeom.GetStageMetersPerUnit(stage) == pytest.approx(0.01)
    root = stage.GetDefaultPrim()
    assert "NaniteAssemblyRootAPI" in root.GetMetadata("apiSchemas").GetAddedOrExplicitItems()
    skeleton = UsdSkel.Skeleton(stage.GetPrimAtPath(root.GetRelationship("unreal:naniteAssembly:skeleton").GetTargets()[0]))
    cache, trunk = UsdSkel.Cache(), UsdSkel.Root(skeleton.GetPrim().GetParent())
    assert cache.Populate(trunk, Usd.PrimDefaultPredicate)
    query = cache.GetSkelQuery(skeleton)
    assert 2 < len(query.GetJointOrder()) <= 120 and query.HasBindPose() and query.HasRestPose()
    names = set(skeleton.GetJointNamesAttr().Get())
    (binding,) = cache.ComputeSkelBindings(trunk, Usd.PrimDefaultPredicate)
    for target in binding.GetSkinningTargets():
        _, weights = target.ComputeJointInfluences()
        per = target.GetNumInfluencesPerComponent()
        sums = [sum(weights[k : k + per]) for k in range(0, len(weights), per)]
        assert min(sums) > 0.999 and max(sums) < 1.001
    instancers = [UsdGeom.PointInstancer(p) for p in stage.Traverse() if p.IsA(UsdGeom.PointInstancer)]
    assert 1 <= len(instancers) <= 5
    for instancer in instancers:
        prim = instancer.GetPrim()
        bound = prim.GetAttribute("primvars:unreal:naniteAssembly:bindJoints").Get()
        assert len(bound) == instancer.GetInstanceCount() and set(bound) <= names
        assert "NaniteAssemblySkelBindingAPI" in prim.GetMetadata("apiSchemas").GetAddedOrExplicitItems()
