"""A small skeleton and a clip, as texts, that several tests read."""

import numpy as np

from mocap.body import euler
from mocap.files import load_save

ASF = """# a leg and an arm
:version 1.10
:name hand made
:units
  mass 1.0
  length 0.0254   # so that a unit is a metre
  angle deg
:documentation
   begin, end and root mean nothing here
:root
   order TX TY TZ RX RY RZ
   axis XYZ
   position 0 0 0
   orientation 0 0 0
:bonedata
  begin
     id 1
     name hip
     direction 0 -1 0
     length 1
     axis 0 0 0 XYZ
  end
  begin
     id 7
     name thigh
     direction 0 -1 0
     length 2
     axis 0 0 90 XYZ
     dof rx rz
     limits (-160.0 20.0)
            (-inf inf)
  end
  begin
     id 9
     name stray
     direction 1 0 0
     length 3
     axis 0 0 0 XYZ
     dof ry
  end
  begin
     id 12
     name arm
     direction 1 0 0
     length 1
     axis 0 0 0 XYZ
     dof rz ry
  end
:hierarchy
  begin
    root hip arm
    hip thigh
  end
:skin none.obj
"""
AMC = """#!OML:ASF hand.ASF
:FULLY-SPECIFIED
:DEGREES
1
root 0 5 0 0 0 0
thigh 0 0
arm 0 0
2
root 1 5 0 0 90 0
thigh 90 0
arm 90 90
"""
SPINE = """:root
  order TX TY TZ RX RY RZ
:bonedata
  begin
    name spine
    direction 0 1 0
    length 1
    axis 0 0 0 XYZ
    dof rx
  end
:hierarchy
  root spine
"""


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
