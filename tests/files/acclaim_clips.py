"""A small skeleton and a clip, as texts, that several tests read."""

import tomllib
from pathlib import Path

import numpy as np

from mocap.body import euler
from mocap.files import load_save

TEXTS = tomllib.loads(Path(__file__).with_name("hand_made.toml").read_text("utf-8"))
ASF, AMC, SPINE = (TEXTS[name] for name in ("ASF", "AMC", "SPINE"))


def read_clip(write, asf=ASF, amc_text=AMC, **options):
    return load_save.load(write("a.amc", amc_text), skeleton=write("a.asf", asf), **options)


def write_acclaim(motion, path):
    """Write a motion as Acclaim files; where children start at several places, still bones lead."""
    skeleton, bones, tree = motion.skeleton, [], []

    def bone(name, way, dofs=""):
        way = " ".join(map(repr, np.asarray(way).tolist()))
        bones.append(f"begin\nname {name}\ndirection {way}\nlength 1\naxis 0 0 0 XYZ\n{dofs}\nend")

    for joint, name in enumerate(["root", *skeleton.names[1:]]):
        children = skeleton.children(joint)
        starts = skeleton.offsets[children]
        together = joint > 0 and len(starts) > 0 and np.all(starts == starts[0])
        end = starts[0] if together else np.zeros(3)  # where children start
        if joint:
            bone(name, end, "dof rx ry rz")
        for child, start in zip([skeleton.names[child] for child in children], starts, strict=True):
            if np.any(start != end):
                bone(f"to_{child}", start)
                tree.append(f"{name} to_{child}")
            tree.append(f"{f'to_{child}' if np.any(start != end) else name} {child}")
    head = [":units", "length 0.0254", ":root", "order TX TY TZ RX RY RZ", ":bonedata"]
    path.with_suffix(".asf").write_text("\n".join([*head, *bones, ":hierarchy", *tree, ""]))
    rows = [":DEGREES"]
    angles = np.degrees(euler.to_euler("xyz", motion.rotations))
    for frame, (place, turns) in enumerate(zip(motion.root_positions, angles, strict=True), 1):
        numbers = [np.concatenate([place, turns[0]]), *turns[1:]]
        named = zip(["root", *skeleton.names[1:]], numbers, strict=True)
        rows += [str(frame), *(f"{name} {' '.join(map(repr, some.tolist()))}" for name, some in named)]
    path.write_text("\n".join([*rows, ""]))
