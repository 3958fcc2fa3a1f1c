"""The recipes of notebooks/RECIPES.md: each program runs in an empty folder, and its files are right."""

import json
import os
import re
import shutil
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import mocap
from mocap import datasets, graphs
from mocap.body import Motion
from tests.files.test_amass import by_hand
from tests.test_types import ROOT

PAGE = ROOT / "notebooks" / "RECIPES.md"
RECIPES = ["pandas", "PyTorch", "AMASS", "Blender, and FBX", "Unreal Engine", "Unity", "Godot", "three.js"]
RECIPES += ["A video", "A cluster"]
SECTIONS = dict(re.findall(r"^## (.*)\n((?s:.*?))(?=^## |\Z)", PAGE.read_text("utf-8"), re.MULTILINE))


def programs(recipe: str, language: str = "python") -> list[str]:
    return re.findall(rf"^```{language}\n((?s:.*?))^```", SECTIONS[recipe], re.MULTILINE)


def run(program: str, folder: Path) -> str:
    """Run a program in a folder, as a reader does; nothing may warn."""
    (folder / "recipe.py").write_text(program, "utf-8")
    command = [sys.executable, "-X", "utf8", "-W", "error::UserWarning", "recipe.py"]
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, encoding="utf-8", check=False, env=environment
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def walk_at(fps: float | None = None, name: str = "walk_straight") -> Motion:
    clip = datasets.sample(name)
    return clip if fps is None else mocap.resample(clip, fps)


def test_there_are_ten_recipes_and_each_says_what_is_tested():
    assert list(SECTIONS) == RECIPES
    for recipe, text in SECTIONS.items():
        assert programs(recipe), recipe
        assert "\nThe test " in text, recipe
        assert re.search(rf"^\| \[{re.escape(recipe)}\]\(#", PAGE.read_text("utf-8"), re.MULTILINE)
    for page in ("README.md", "notebooks/README.md"):
        assert "RECIPES.md)" in (ROOT / page).read_text("utf-8")


def test_pandas_has_a_table_of_positions(tmp_path):
    pandas = pytest.importorskip("pandas", reason="no pandas here: pip install pandas")
    (program,) = programs("pandas")
    printed = run(program, tmp_path)
    table = pandas.read_csv(tmp_path / "positions.csv", index_col="time")
    walk = walk_at()
    head = walk.positions[:, walk.skeleton.index("head")]
    assert np.allclose(table[["head_x", "head_y", "head_z"]], head, atol=1e-6)
    assert np.allclose(table.index, np.arange(len(walk)) / walk.fps)
    assert "toes_y" in printed
    assert re.search(r"max +[2-5]\.\d\d", printed)  # feet swing at some metres per second


def test_torch_has_windows_of_a_second(tmp_path):
    pytest.importorskip("torch", reason="no PyTorch here: pip install torch")
    (program,) = programs("PyTorch")
    walk = walk_at(30, "walk_circle")
    check = (
        "assert windows.shape == ((len(walk) - 30) // 8 + 1, 30, 6 * len(walk.skeleton))\n"
        "assert torch.equal(windows[3, 7], frames[3 * 8 + 7])\n"
        "assert np.array_equal(rotations, walk.rotations) and contacts.shape == (len(walk), 4)\n"
        "print(float(frames.reshape(len(walk), -1, 6)[9, 5, 1]))\n"
    )
    printed = run(program + check, tmp_path)
    assert f"torch.Size([16, 30, {6 * len(walk.skeleton)}])" in printed
    assert float(printed.split()[-1]) == pytest.approx(walk.positions[9, 5, 1], abs=1e-6)


def test_the_arrays_for_torch_are_those_of_the_motion(tmp_path):
    """The part of the recipe before PyTorch is needed."""
    (program,) = programs("PyTorch")
    start = program.index("walk = ")
    run(f"import mocap\nfrom mocap import datasets\n{program[start : program.index('with np')]}", tmp_path)
    walk = walk_at(30, "walk_circle")
    with np.load(tmp_path / "walk.npz") as arrays:
        assert np.array_equal(arrays["rotations"], walk.rotations)
        for name, mark in zip(arrays["contact_names"], arrays["contacts"].T, strict=True):
            assert np.array_equal(mark, walk.contacts[name])


def test_an_archive_of_amass_comes_back_as_the_motion_that_it_holds(tmp_path):
    (program,) = programs("AMASS")
    printed = run(f"{program}\nnp.save('positions.npy', smpl.positions)\n", tmp_path)
    walk = mocap.load(tmp_path / "walk_poses.npz")
    assert walk.fps == 30 and repr(walk) in printed
    assert np.abs(walk.positions - np.load(tmp_path / "positions.npy")).max() < 1e-9  # metres
    with np.load(tmp_path / "walk_poses.npz") as archive:
        assert {"poses", "trans", "betas", "dmpls", "gender", "mocap_framerate"} <= set(archive.files)
        placed = by_hand(archive["poses"][9, :66], archive["trans"][9])
        assert 1.5 < archive["trans"][:, 2].mean() + 0.7 < 2  # z is up
    x, y, z = walk.positions[9].T
    assert np.abs(placed - np.stack([x, -z, y], axis=-1)).max() < 1e-9  # metres


# A .glb, and the programs that read it ----------------------------------------------------------------------


def glb_document(path: Path) -> dict:
    """Return the JSON text of a `.glb` file."""
    data = path.read_bytes()
    magic, version, size, length, kind = struct.unpack("<4sIII4s", data[:20])
    assert (magic, version, size, kind) == (b"glTF", 2, len(data), b"JSON")
    return json.loads(data[20 : 20 + length])


def rest_positions(nodes: list[dict], roots: list[int]) -> np.ndarray:
    """Return the positions of nodes at rest, in metres; no node is scaled."""
    positions = {}
    waiting = [(root, np.zeros(3), Rotation.identity()) for root in roots]
    while waiting:
        node, origin, above = waiting.pop()
        assert not {"scale", "matrix"} & set(nodes[node])
        positions[node] = origin + above.apply(nodes[node].get("translation", [0, 0, 0]))
        here = above * Rotation.from_quat(nodes[node].get("rotation", [0, 0, 0, 1]))
        waiting += [(child, positions[node], here) for child in nodes[node].get("children", [])]
    return np.array([positions[node] for node in sorted(positions)])


GLBS = {
    "Blender, and FBX": ("walk.glb", "walk_straight", None),
    "Unreal Engine": ("walk.glb", "walk_straight", 30),
    "Unity": ("jog.glb", "jog", 30),
    "Godot": ("sneak.glb", "sneak", 30),
    "three.js": ("walk.glb", "walk_straight", 30),
}


@pytest.mark.parametrize("recipe", GLBS)
def test_the_file_for_engines_has_one_root_metres_y_up_and_the_animation(recipe, tmp_path):
    file, name, fps = GLBS[recipe]
    run(programs(recipe)[0], tmp_path)
    motion = walk_at(fps, name)
    document = glb_document(tmp_path / file)
    joints = document["skins"][0]["joints"]
    assert [document["nodes"][joint]["name"] for joint in joints] == list(motion.skeleton.names)
    children = {child for node in document["nodes"] for child in node.get("children", [])}
    assert set(joints) - children == {document["skins"][0]["skeleton"]}  # one root
    rest = rest_positions(document["nodes"], [document["skins"][0]["skeleton"]])
    assert rest[:, 1].min() == pytest.approx(0, abs=1e-6)  # y is up, and it stands on the ground
    assert 1.5 < rest[:, 1].max() < 2  # metres
    (animation,) = document["animations"]
    assert animation["name"] == motion.name
    times = document["accessors"][animation["samplers"][0]["input"]]
    assert times["count"] == len(motion) and times["max"][0] == pytest.approx(motion.duration, abs=1e-4)
    targets = [channel["target"] for channel in animation["channels"]]
    moved = [target["node"] for target in targets if target["path"] == "translation"]
    assert moved == [document["skins"][0]["skeleton"]]


# Debian's Blender of 2022 runs with a younger NumPy, which lacks a name that its importer uses.
OLD_NAMES = "import numpy\nnumpy.bool = bool\n"


def test_the_script_for_blender_is_python_and_writes_an_fbx(tmp_path):
    program, script = programs("Blender, and FBX")
    compile(script, "to_fbx.py", "exec")
    blender = shutil.which("blender")
    if not blender:
        pytest.skip("no Blender here: apt-get install blender")
    run(program, tmp_path)
    (tmp_path / "to_fbx.py").write_text(OLD_NAMES + script, "utf-8")
    command = [blender, "--background", "--factory-startup", "--python-exit-code", "1"]
    command += ["--python", "to_fbx.py", "--", "walk.glb", "walk.fbx"]
    here = {**os.environ, "PWD": str(tmp_path)}  # which Blender takes for the current folder
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, env=here)
    assert done.returncode == 0, done.stdout + done.stderr
    data = (tmp_path / "walk.fbx").read_bytes()
    assert data.startswith(b"Kaydara FBX Binary") and b"lfoot" in data and b"AnimCurve" in data


def test_three_js_has_the_joints_where_ours_are_after_a_second(tmp_path):
    program = programs("three.js")[0]
    (module,) = programs("three.js", "js")
    run(program, tmp_path)
    page = (tmp_path / "walk.html").read_text("utf-8")
    assert 'src="walk.mjs"' in page and "importmap" in page
    library = three_folder()
    (tmp_path / "node_modules").mkdir()
    (tmp_path / "node_modules" / "three").symlink_to(library)
    (tmp_path / "walk.mjs").write_text(module, "utf-8")
    (tmp_path / "check.mjs").write_text(CHECK, "utf-8")
    done = subprocess.run(["node", "check.mjs"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    walk = walk_at(30)
    places = json.loads(done.stdout)
    assert len(places) == len(walk.skeleton)
    expected = {name: walk.positions[30, walk.skeleton.index(name)] for name in places}
    assert max(np.abs(expected[name] - places[name]).max() for name in places) < 1e-3  # metres


CHECK = """
import { readFileSync } from "node:fs";
import { Vector3 } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { playing } from "./walk.mjs";

const { buffer, byteOffset, length } = readFileSync("walk.glb");
const gltf = await new GLTFLoader().parseAsync(buffer.slice(byteOffset, byteOffset + length), "");
playing(gltf).setTime(1.0);
gltf.scene.updateMatrixWorld(true);
const places = {};
gltf.scene.traverse((node) => {
  if (node.isBone) places[node.name] = node.getWorldPosition(new Vector3()).toArray();
});
console.log(JSON.stringify(places));
"""


def three_folder() -> Path:
    """Return the folder of the npm package three, where Node.js finds one."""
    if shutil.which("node"):
        asked = "console.log(require.resolve('three/addons/loaders/GLTFLoader.js'))"
        done = subprocess.run(["node", "-e", asked], capture_output=True, text=True, check=False)
        if done.returncode == 0:
            return Path(done.stdout.strip()).parents[3]
    pytest.skip("no three.js here: npm install three, and name its folder in NODE_PATH")


def test_a_video_is_written_as_gif_and_as_mp4(tmp_path):
    pytest.importorskip("imageio_ffmpeg", reason="no imageio-ffmpeg here: pip install '.[video]'")
    (program,) = programs("A video")
    run(program, tmp_path)
    assert (tmp_path / "walks.gif").read_bytes().startswith(b"GIF89a")
    assert (tmp_path / "walks.mp4").read_bytes()[4:8] == b"ftyp"


@pytest.mark.parametrize("number", [0, 1], ids=["processes", "dask"])
def test_a_cluster_builds_the_same_graph(number, tmp_path):
    if number == 1:
        pytest.importorskip("distributed", reason="no Dask here: pip install 'dask[distributed]'")
    run(programs("A cluster")[number], tmp_path)
    clips = [mocap.resample(datasets.sample(name), 30) for name in ("walk_circle", "walk_curve_1")]
    here = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    there = graphs.load(tmp_path / "graph.npz")
    assert sorted(there.graph.edges(data="cost")) == sorted(here.graph.edges(data="cost"))
