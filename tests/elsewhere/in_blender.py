"""Import our files in Blender, and compare the positions of all joints there with ours.

    blender --background --factory-startup --python-exit-code 1 --python THIS FILE -- FOLDER
    python THIS FILE -- FOLDER        # with Blender as a package, `pip install bpy`

FOLDER is the one that `write_files.py` wrote. A `.bvh` is imported at a scale of 0.01, because its unit is
the centimetre and Blender's is the metre, and with the scene's frame rate taken from the file. A `.glb` is
in metres, and its keys are in seconds: it is imported with the defaults, into a scene with 24 frames per
second, and compared at each of its own frames, which lie between those of the scene. Blender's z is up, ours
is y.

A joint is the head of a bone. The `End Site` of a `.bvh` has no bone in Blender: it is the tail of its
parent's. The largest distance of a joint and the length in frames are printed for each animation of a file,
and the command fails if one of them is wrong, or the frame rate of a `.bvh`.

For a `.glb` there are three more numbers. A bone with one child points at it: `bone °` is the largest angle
between the bone and the direction of the child. In the rest pose the lowest joint is on the floor: `floor mm`
is its height. The pose to which the skin is bound is the rest pose: `bind mm` is the largest difference of a
number in the matrices of the bones, if they are imported from either.

Debian 12 has Blender 3.4 of 2022. It runs with a Python and a NumPy that are younger, and both importers fail
there for every file: `mend_importers` restores the two names that are gone, and changes nothing else.
"""

import io
import sys
from contextlib import redirect_stdout
from importlib import import_module
from pathlib import Path

import bpy
import numpy as np

# mm. The largest distances were 0.051 and 0.014 mm. Blender converts the Euler angles of a .bvh in 32 bits,
# with an error that grows near gimbal lock.
BOUNDS = {".bvh": 0.1, ".glb": 0.03}
ANGLE_BOUND = 0.1  # degrees between a bone and the direction of its only child; the largest was 0.01
REST_BOUND = 0.01  # mm in the rest pose; the largest was 0.001 mm
SHORT = 1e-4  # metres: a child that is nearer has no direction
FRAME_BOUND = 1e-3  # frames by which the length of an animation may differ: Blender keeps times in 32 bits
MOST_FRAMES = 100  # that are compared in a file, spread evenly over it


def import_file(path, **options):
    """Import a file into an empty scene and return its armature."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    mend_importers()
    with redirect_stdout(io.StringIO()):  # the importers print what they do
        if path.suffix == ".bvh":
            import_bvh(path)
        else:
            bpy.ops.import_scene.gltf(filepath=str(path), **options)
    (armature,) = [item for item in bpy.context.scene.objects if item.type == "ARMATURE"]
    return armature


def import_bvh(path):
    """Import a .bvh in centimetres, with its frame rate."""
    bpy.ops.import_anim.bvh(
        filepath=str(path), global_scale=0.01, update_scene_fps=True, update_scene_duration=True
    )


def mend_importers():
    """Restore two old names for Blender 3.4: the mode "rU" of files, and `np.bool` of NumPy."""
    if bpy.app.version < (3, 5):
        import_module("io_anim_bvh.import_bvh").open = open_text
        np.bool = bool


def open_text(file, mode):
    """Open a file in a mode without "U", which has been the default since Python 3.0."""
    return Path(file).open(mode.replace("U", ""))


def scene_rate():
    """Return the frames per second of the scene."""
    render = bpy.context.scene.render
    return render.fps / render.fps_base


def play(armature, clip):
    """Let an armature play the animation of a clip alone."""
    data = armature.animation_data
    for track in data.nla_tracks:
        track.mute = True
    if len(bpy.data.actions) > 1:  # a .glb with several
        (data.action,) = [action for action in bpy.data.actions if action.name.startswith(clip)]
    if bpy.app.version >= (4, 4):
        data.action_slot = data.action.slots[0]
    for bone in armature.pose.bones:
        bone.matrix_basis.identity()  # what the animation played before has left


def curves_of(armature):
    """Return the curves of the animation that an armature plays."""
    data = armature.animation_data
    if bpy.app.version < (4, 4):
        return data.action.fcurves
    (strip,) = data.action.layers[0].strips
    return strip.channelbag(data.action_slot).fcurves


def key_range(armature):
    """Return the scene's frames of the first and the last key; `frame_range` of Blender is never empty."""
    curves = curves_of(armature)
    frames = [key.co.x for curve in curves for key in (curve.keyframe_points[0], curve.keyframe_points[-1])]
    return min(frames), max(frames)


def to_y_up(point):
    """Convert a point from Blender's axes to ours."""
    return [point.x, point.z, -point.y]


def bone_ends(armature, frame):
    """Return the heads and the tails of all bones at a frame, which may lie between two of the scene."""
    whole = int(np.floor(frame))
    bpy.context.scene.frame_set(whole, subframe=float(frame - whole))
    posed = armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
    heads = {bone.name: to_y_up(posed.matrix_world @ bone.head) for bone in posed.pose.bones}
    tails = {bone.name: to_y_up(posed.matrix_world @ bone.tail) for bone in posed.pose.bones}
    return heads, tails


def joint_points(armature, frame, names, parents):
    """Return the positions of all joints, shape (J, 3): heads of bones, else the parent's tail."""
    heads, tails = bone_ends(armature, frame)
    points = []
    for name, parent in zip(names, parents, strict=True):
        points.append(heads[name] if name in heads else tails[names[parent]])
    return np.array(points)


def largest_angle(armature):
    """Return the largest angle between a bone and the direction of its only child, degrees."""
    angles = [0.0]
    for bone in armature.data.bones:
        offsets = [child.head_local - bone.head_local for child in bone.children]
        offsets = [offset for offset in offsets if offset.length > SHORT]
        if len(offsets) == 1:
            angles.append(np.degrees((bone.tail_local - bone.head_local).angle(offsets[0])))
    return max(angles)


def rest_matrices(path, **options):
    """Return the matrices of the bones in the rest pose, (B, 4, 4)."""
    armature = import_file(path, **options)
    return np.array([armature.matrix_world @ bone.matrix_local for bone in armature.data.bones])


def compare_rest(path):
    """Print a line about the rest pose of a .glb, and return whether it is right."""
    bound = rest_matrices(path)
    at_nodes = rest_matrices(path, guess_original_bind_pose=False)
    armature = import_file(path)
    angle = largest_angle(armature)
    floor = 1000 * min((armature.matrix_world @ bone.head_local).z for bone in armature.data.bones)
    difference = 1000 * np.abs(bound - at_nodes).max()
    right = angle <= ANGLE_BOUND and max(abs(floor), difference) <= REST_BOUND
    numbers = f"bone ° {angle:.4f}  floor mm {floor:.4f}  bind mm {difference:.4f}"
    print(f"{path.name:32} {numbers}{'' if right else '  WRONG'}")
    return right


def compare(path):
    """Print lines about a file, and return whether all of it is right."""
    results = [compare_rest(path)] if path.suffix == ".glb" else []
    armature = import_file(path)
    for stored in sorted(path.parent.glob(f"{path.stem}@*.npz")):
        results.append(compare_clip(path, armature, stored))
    return len(results) > (path.suffix == ".glb") and all(results)


def compare_clip(path, armature, positions_file):
    """Print a line about an animation of a file, and return whether it is right."""
    clip = positions_file.stem.partition("@")[2]
    play(armature, clip)
    with np.load(positions_file) as stored:
        names = stored["names"].tolist()
        parents = stored["parents"].tolist()
        positions = stored["positions"]
        fps = float(stored["fps"])
    rate = scene_rate()
    first, last = key_range(armature)
    distances = []
    step = rate / fps if path.suffix == ".glb" else 1.0  # a .bvh has a key in each frame of the scene
    for frame in np.unique(np.linspace(0, len(positions) - 1, MOST_FRAMES).round().astype(int)):
        points = joint_points(armature, first + step * frame, names, parents)
        distances.append(np.linalg.norm(points - positions[frame], axis=1))
    millimetres = 1000 * np.max(distances)
    length = (last - first) * fps / rate + 1
    right = millimetres <= BOUNDS[path.suffix] and abs(length - len(positions)) <= FRAME_BOUND
    if path.suffix == ".bvh":
        right = right and abs(rate - fps) <= 1e-6 * fps
    counts = f"{len(names):6} {len(positions):7} {length:10.3f}"
    name = path.name if clip == path.stem else f"{path.name} {clip}"
    print(f"{name:32} {counts} {fps:5g} {rate:5g} {millimetres:11.4f}{'' if right else '  WRONG'}")
    return right


def main():
    """Compare all files of the folder that the command names."""
    folder = Path(sys.argv[sys.argv.index("--") + 1])
    files = sorted([*folder.glob("*.bvh"), *folder.glob("*.glb")])
    print(f"Blender {bpy.app.version_string}; at most, in mm: {BOUNDS}")
    print(
        f"{'file':32} {'joints':>6} {'frames':>7} {'imported':>10} {'Hz':>6} {'scene':>6} {'largest mm':>10}"
    )
    wrong = [path.name for path in files if not compare(path)]
    if wrong or not files:
        raise SystemExit(f"Wrong in Blender: {', '.join(wrong) or 'no files'}")


if __name__ == "__main__":
    main()
