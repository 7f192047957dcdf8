"""One function a format: reads the file with the library of those who use it, and says how far it is from the JSON."""

import csv as table
import json
import struct
from types import SimpleNamespace

import numpy as np
import pygltflib
import pyvista
import trimesh
from pxr import Usd, UsdGeom

# Round-off of double precision; and of single, in which glTF and USD have places, m.
DOUBLE, SINGLE = 1e-15, 1e-6


def expected(file):
    """What the JSON has: times, and of each rod its arrays with the frames in front."""
    answer = json.loads(file.read_text())
    frames = answer["frames"]
    names = list(frames[0]["rods"])
    rods = {
        name: {key: np.array([frame["rods"][name][key] for frame in frames]) for key in frames[0]["rods"][name]}
        for name in names
    }
    moved = max(np.ptp(rod["position"], axis=0).max() for rod in rods.values())
    assert moved > 0.05, f"nothing moves: {moved} m"
    energy = {key: np.array([frame["energy"][key] for frame in frames]) for key in frames[0]["energy"]}
    return SimpleNamespace(time=np.array([frame["t"] for frame in frames]), rods=rods, energy=energy)


def near(what, got, wanted, within):
    """How far an array is from what it should be."""
    got, wanted = np.asarray(got, dtype=float), np.asarray(wanted, dtype=float)
    assert got.shape == wanted.shape, f"{what}: {got.shape} in place of {wanted.shape}"
    off = np.abs(got - wanted).max()
    assert off <= within, f"{what} is off by {off}"
    return off


def csv(file, expected):
    with open(file, newline="") as text:
        rows = list(table.DictReader(text))
    off = 0.0
    for name, rod in expected.rods.items():
        of_rod = [row for row in rows if row["rod"] == name]
        for key, columns in (("position", "x y z"), ("orientation", "qw qx qy qz"), ("velocity", "vx vy vz")):
            got = np.array([[float(row[column]) for column in columns.split()] for row in of_rod])
            off = max(off, near(f"{name}.{key}", got.reshape(rod[key].shape), rod[key], DOUBLE))
    return f"csv: {len(rows)} rows, off by {off:.0e}"


def npz(file, expected):
    archive = np.load(file)
    off = near("time", archive["time"], expected.time, DOUBLE)
    for key, written in (("kinetic", "kinetic"), ("elastic", "elastic"), ("gravity", "load"), ("dissipated", "dissipated")):
        off = max(off, near(key, archive[f"energy.{written}"], expected.energy[key], DOUBLE))
    for name, rod in expected.rods.items():
        off = max(off, near(f"{name}.s", archive[f"{name}.s"], rod["s"][0], DOUBLE))
        for key in ("position", "orientation", "velocity", "angular_velocity", "strain", "stress"):
            scale = max(1.0, np.abs(rod[key]).max())
            off = max(off, near(f"{name}.{key}", archive[f"{name}.{key}"] / scale, rod[key] / scale, DOUBLE))
    return f"numpy {np.__version__}: {len(archive.files)} arrays, off by {off:.0e}"


def pvd(file, expected):
    reader = pyvista.get_reader(file)
    near("time", reader.time_values, expected.time, DOUBLE)
    off = 0.0
    for frame, time in enumerate(reader.time_values):
        reader.set_active_time_value(time)
        parts = reader.read()
        assert len(parts) == len(expected.rods)
        for number, (part, rod) in enumerate(zip(parts, expected.rods.values())):
            off = max(off, near("position", part.points, rod["position"][frame], DOUBLE))
            off = max(off, near("velocity", part.point_data["velocity"], rod["velocity"][frame], DOUBLE))
            off = max(off, near("moment", part.cell_data["moment"], rod["stress"][frame][:, :3], DOUBLE))
            assert part.n_lines == rod["position"].shape[1] - 1 and set(part.cell_data["rod"]) == {number}
            length = part.compute_cell_sizes()["Length"].sum()
            assert abs(length / rod["s"][frame][-1] - 1.0) < 0.02, f"the lines are {length} m long"
    return f"pyvista {pyvista.__version__}: {len(expected.time)} times of {len(expected.rods)} rods, off by {off:.0e}"


def usda(file, expected):
    stage = Usd.Stage.Open(str(file))
    assert UsdGeom.GetStageUpAxis(stage) == "Z" and UsdGeom.GetStageMetersPerUnit(stage) == 1.0
    curves = [UsdGeom.BasisCurves(prim) for prim in stage.Traverse() if prim.IsA(UsdGeom.BasisCurves)]
    curves = {curve.GetPrim().GetCustomDataByKey("name"): curve for curve in curves}
    assert list(curves) == list(expected.rods), list(curves)
    off = 0.0
    for name, rod in expected.rods.items():
        curve, nodes = curves[name], rod["position"].shape[1]
        codes = curve.GetPointsAttr().GetTimeSamples()
        near("time", np.array(codes) / stage.GetTimeCodesPerSecond(), expected.time, 1e-12)
        assert list(curve.GetCurveVertexCountsAttr().Get()) == [nodes]
        assert curve.GetWidthsInterpolation() == "vertex"
        assert len(curve.GetWidthsAttr().Get()) == nodes
        for frame, code in enumerate(codes):
            off = max(off, near("points", curve.GetPointsAttr().Get(code), rod["position"][frame], SINGLE))
            near("velocities", curve.GetVelocitiesAttr().Get(code), rod["velocity"][frame], 10 * SINGLE)
            computed = UsdGeom.Boundable.ComputeExtentFromPlugins(curve, code)
            near("extent", curve.GetExtentAttr().Get(code), computed, SINGLE)
    version = ".".join(map(str, Usd.GetVersion()[1:]))
    return f"usd {version}: {len(curves)} curves, {len(expected.time)} time samples, off by {off:.0e} m"


def glb(file, expected):
    """Plays it as a viewer does: nodes from the animation, half-way between frames too, and the skin from the nodes."""
    gltf = pygltflib.GLTF2().load(file)
    channels = {(c.target.node, c.target.path): gltf.animations[0].samplers[c.sampler] for c in gltf.animations[0].channels}
    scene = trimesh.load(file)
    off = 0.0
    for mesh, (name, rod) in enumerate(expected.rods.items()):
        joints = gltf.skins[mesh].joints
        assert gltf.meshes[mesh].name == name and len(joints) == rod["position"].shape[1]
        (root,) = [node for node in gltf.nodes if node.children and joints[0] in node.children]
        upright = matrix([0.0, 0.0, 0.0], root.rotation)
        attributes = gltf.meshes[mesh].primitives[0].attributes
        vertices = np.c_[numbers(gltf, attributes.POSITION), np.ones(gltf.accessors[attributes.POSITION].count)]
        of_joint = numbers(gltf, attributes.JOINTS_0)[:, 0].astype(int)
        unbound = numbers(gltf, gltf.skins[mesh].inverseBindMatrices).reshape(-1, 4, 4).transpose(0, 2, 1)
        times = numbers(gltf, channels[joints[0], "translation"].input)[:, 0]
        near("time", times, expected.time, SINGLE)
        moves = [[numbers(gltf, channels[joint, path].output) for path in ("translation", "rotation")] for joint in joints]
        radius = np.linalg.norm((unbound[of_joint] @ vertices[:, :, None])[:, :2, 0], axis=1)
        volumes = []
        for at in np.arange(0.0, len(times) - 0.5, 0.5):
            before, after = int(at), int(np.ceil(at))
            poses = [
                matrix(0.5 * (places[before] + places[after]), slerp(turns[before], turns[after], 0.5))
                for places, turns in moves
            ]
            places = np.array([pose[:3, 3] for pose in poses])
            if before == after:
                off = max(off, near(name, places, rod["position"][before], SINGLE))
            drawn = np.array([upright @ poses[j] @ unbound[j] @ v for j, v in zip(of_joint, vertices)])[:, :3]
            world = np.c_[drawn[:, 0], -drawn[:, 2], drawn[:, 1]]
            near("distance from the node", np.linalg.norm(world - places[of_joint], axis=1), radius, SINGLE)
            still = scene.geometry[name]
            if at == 0.0:
                near("first frame", drawn, vertices[:, :3], SINGLE)
                assert len(still.vertices) > 0 and still.volume > 0.0
            faces = numbers(gltf, gltf.meshes[mesh].primitives[0].indices).reshape(-1, 3).astype(int)
            volumes.append(trimesh.Trimesh(drawn, faces, process=False).volume)
        assert np.ptp(volumes) < 0.02 * volumes[0], f"{name} swells from {min(volumes)} to {max(volumes)} m³"
    return f"pygltflib {pygltflib.__version__}, trimesh {trimesh.__version__}: {len(gltf.skins)} skins, off by {off:.0e} m"


def numbers(gltf, index):
    """The vectors of an accessor."""
    accessor = gltf.accessors[index]
    view = gltf.bufferViews[accessor.bufferView]
    size = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}[accessor.type]
    kind = {pygltflib.FLOAT: "f", pygltflib.UNSIGNED_SHORT: "H", pygltflib.UNSIGNED_INT: "I"}[accessor.componentType]
    values = struct.unpack_from(f"<{accessor.count * size}{kind}", gltf.binary_blob(), view.byteOffset)
    return np.array(values, dtype=float).reshape(accessor.count, size)


def matrix(place, turn):
    """The matrix of a node of glTF, whose quaternion has w last."""
    x, y, z, w = turn
    rotation = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.block([[np.array(rotation), np.reshape(place, (3, 1))], [np.zeros((1, 3)), np.ones((1, 1))]])


def slerp(a, b, part):
    """Between two quaternions, as glTF interpolates them linearly."""
    angle = np.arccos(np.clip(a @ b, -1.0, 1.0))
    if angle < 1e-6:
        return a
    return (np.sin((1 - part) * angle) * a + np.sin(part * angle) * b) / np.sin(angle)
