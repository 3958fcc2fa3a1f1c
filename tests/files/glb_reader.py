"""A small reader of `.glb` files: it checks their structure, and plays their skeleton without our package."""

import json
import struct

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

NUMBERS = {5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
COUNTS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class Glb:
    """The document of a file, and its arrays, with shares already divided by their largest number."""

    def __init__(self, data):
        magic, version, size = struct.unpack("<4sII", data[:12])
        assert (magic, version, size) == (b"glTF", 2, len(data))
        chunks, at = {}, 12
        while at < len(data):
            length, kind = struct.unpack("<I4s", data[at : at + 8])
            assert length % 4 == 0
            chunks[kind] = data[at + 8 : at + 8 + length]
            at += 8 + length
        self.document = json.loads(chunks[b"JSON"])
        (buffer,) = self.document["buffers"]
        assert buffer["byteLength"] == len(chunks[b"BIN\0"])
        self.arrays = [self._array(accessor, chunks[b"BIN\0"]) for accessor in self.document["accessors"]]
        self.nodes = self.document["nodes"]
        self.joints = self.document["skins"][0]["joints"]

    def _array(self, accessor, data):
        view = self.document["bufferViews"][accessor["bufferView"]]
        number = np.dtype(NUMBERS[accessor["componentType"]])
        count = COUNTS[accessor["type"]]
        assert view["byteOffset"] % 4 == 0
        assert view["byteLength"] == accessor["count"] * count * number.itemsize
        start = view["byteOffset"]
        raw = np.frombuffer(data[start : start + view["byteLength"]], number).reshape(-1, count)
        for bound, found in (("min", raw.min(0)), ("max", raw.max(0))):
            if bound in accessor:
                assert np.array_equal(accessor[bound], found)
        if not accessor.get("normalized"):
            return raw
        return np.maximum(raw.astype(float) / np.iinfo(number).max, -1.0)

    def parents(self):
        above = {child: node for node, row in enumerate(self.nodes) for child in row.get("children", ())}
        return [above.get(node, -1) for node in range(len(self.nodes))]

    def curves(self, clip=None):
        """Return {(node, path): (times, values)} of an animation by its name, or of the only one."""
        clips = {animation["name"]: animation for animation in self.document["animations"]}
        animation = clips[clip] if clip is not None else clips.popitem()[1]
        assert clip is not None or not clips
        found = {}
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["sampler"]]
            times = self.arrays[sampler["input"]][:, 0]
            assert np.all(np.diff(times) > 0)
            assert {"min", "max"} <= set(self.document["accessors"][sampler["input"]])
            of = channel["target"]
            found[of["node"], of["path"]] = (times, self.arrays[sampler["output"]])
        return found

    def poses(self, seconds, rest=False, clip=None):
        """Give every joint's matrix (4, 4) in the world, at a time of an animation or at rest."""
        curves, local = {} if rest else self.curves(clip), []
        for node in range(len(self.nodes)):
            matrix = np.eye(4)
            matrix[:3, 3] = self.nodes[node].get("translation", np.zeros(3))
            turn = self.nodes[node].get("rotation", [0.0, 0.0, 0.0, 1.0])
            assert abs(np.linalg.norm(turn) - 1) < 1e-6
            matrix[:3, :3] = Rotation.from_quat(turn).as_matrix()
            if (node, "translation") in curves:
                times, places = curves[node, "translation"]
                matrix[:3, 3] = [np.interp(seconds, times, column) for column in places.T]
            if (node, "rotation") in curves:
                times, turns = curves[node, "rotation"]
                matrix[:3, :3] = Slerp(times, Rotation.from_quat(turns))(seconds).as_matrix()
            local.append(matrix)
        return np.array([self._in_world(node, local) for node in self.joints])

    def _in_world(self, node, local):
        """Multiply the matrices of a node and of all above it."""
        parents, matrix = self.parents(), local[node]
        while (node := parents[node]) >= 0:
            matrix = local[node] @ matrix
        return matrix

    def inverse_binds(self):
        """Return the inverse bind matrix of each joint, (J, 4, 4)."""
        by_columns = self.arrays[self.document["skins"][0]["inverseBindMatrices"]]
        return by_columns.reshape(-1, 4, 4).swapaxes(1, 2)

    def skinned(self, seconds, rest=False):
        """Give where the body's corners are, (V, 3): the sum of weight · joint · inverse bind · corner."""
        attributes = self.document["meshes"][0]["primitives"][0]["attributes"]
        places, joints, weights = (self.arrays[attributes[k]] for k in ("POSITION", "JOINTS_0", "WEIGHTS_0"))
        moves = self.poses(seconds, rest) @ self.inverse_binds()
        mixed = np.einsum("vk,vkij->vij", weights, moves[joints])
        return np.einsum("vij,vj->vi", mixed, np.c_[places, np.ones(len(places))])[:, :3]
