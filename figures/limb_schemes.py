"""How well limbs are found on bodies with the bones and names of 43 public schemes, and on odd bodies.

    python figures/limb_schemes.py                # the table for a bundled walk
    python figures/limb_schemes.py --clip jog     # for another bundled clip
    python figures/limb_schemes.py --limits       # wrong joints with each limit halved and doubled
    python figures/limb_schemes.py --mixed 50     # rigs of three kinds at a time, with random names
    python figures/limb_schemes.py --files FOLDER # captured clips under random names

All bodies have the proportions of one walker. A scheme changes the names of the joints of legs and arms, and
the bones: fingers, joints for a twist, roots on the floor, hair. The names are those of public files and of
the manuals of programs.
"""

import argparse
import time
import warnings
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from types import ModuleType

import numpy as np

from mocap._shared.arrays import Array
from mocap.body import limb_pairs, limb_roles, limb_search, limb_tree
from mocap.body.kinematics import forward_kinematics
from mocap.body.limb_search import FoundLimbs, find_limbs
from mocap.body.skeleton import Skeleton
from mocap.datasets import SAMPLES, sample
from mocap.errors import MocapError, MocapWarning
from mocap.files.conversion import find_files
from mocap.files.load_save import read

SIDES = {"left": 1, "right": -1}  # and the sign of x on that side
LEG = ("hip", "knee", "ankle", "ball", "tip")
ARM = ("clavicle", "shoulder", "elbow", "wrist", "hand")
COMPARED = (*LEG, *ARM[1:4])  # roles of each side that are looked for
TRUNK = {
    "root": "hips",
    "lowerback": "spine1",
    "upperback": "spine2",
    "thorax": "spine3",
    "lowerneck": "neck1",
    "upperneck": "neck2",
    "head": "head",
    "head_end": "top",
}
BONES = {
    "femur": "hip",
    "tibia": "knee",
    "foot": "ankle",
    "toes": "ball",
    "toes_end": "tip",
    "clavicle": "clavicle",
    "humerus": "shoulder",
    "radius": "elbow",
    "hand": "wrist",
    "fingers_end": "hand",
}
LIMBS = {f"{side[0]}{bone}": f"{side} {role}" for side in SIDES for bone, role in BONES.items()}
ROLES = TRUNK | LIMBS  # of the bundled body's joints; the hip bones beside the pelvis are left out
Vector = Sequence[float]
Change = Callable[["Rig"], None]


@dataclass
class Rig:
    """A moving body as a table of joints; `turns` are the frames in which things hang on a joint.

    Parameters
    ----------
    parents : of each joint its parent, "" for the root.
    positions : of each joint, (F, 3), metres.
    turns : of each joint, matrices (F, 3, 3).
    """

    parents: dict[str, str] = field(default_factory=dict)
    positions: dict[str, Array] = field(default_factory=dict)
    turns: dict[str, Array] = field(default_factory=dict)

    def add(self, name: str, parent: str, positions: Array) -> None:
        """Put a joint at places in the world."""
        self.parents[name] = parent
        self.positions[name] = positions
        self.turns[name] = self.turns[parent]

    def hang(self, name: str, parent: str, offset: Vector) -> None:
        """Put a joint at a place in the frame of its parent."""
        self.add(name, parent, self.positions[parent] + self.turns[parent] @ np.array(offset))

    def hang_chain(self, name: str, parent: str, first: Vector, later: Vector, count: int) -> None:
        """Hang several joints one below the other."""
        for number in range(count):
            self.hang(f"{name} {number}", parent, later if number else first)
            parent = f"{name} {number}"

    def insert(self, name: str, child: str, fraction: float = 0.5, *, splits: bool = True) -> None:
        """Put a joint on the bone to a child, which then hangs on it; or beside the bone."""
        parent = self.parents[child]
        along = self.positions[child] - self.positions[parent]
        self.add(name, parent, self.positions[parent] + fraction * along)
        if splits:
            self.parents[child] = name

    def drop(self, name: str) -> None:
        """Leave out a joint; those below hang on the one above."""
        for child, parent in self.parents.items():
            if parent == name:
                self.parents[child] = self.parents[name]
        for table in (self.parents, self.positions, self.turns):
            del table[name]

    def has_flat_toes(self) -> bool:
        """Return whether the toes are at the ankles, but for noise."""
        feet = [self.positions[f"{side} ball"] - self.positions[f"{side} ankle"] for side in SIDES]
        return bool(np.abs(np.mean(feet, axis=1)).max() < 1e-2)

    def names(self) -> list[str]:
        """List the joints, parents first, in the order in which they were added."""
        ordered = [name for name, parent in self.parents.items() if not parent]
        for name in ordered:
            ordered += [child for child, parent in self.parents.items() if parent == name]
        return ordered

    def skeleton(self, rename: Mapping[str, str]) -> tuple[Skeleton, Array]:
        """Return the body under other names, and the positions of its joints, (F, J, 3)."""
        names = self.names()
        parents = [names.index(self.parents[name]) if self.parents[name] else -1 for name in names]
        positions = np.stack([self.positions[name] for name in names], axis=1)
        offsets = positions[0] - positions[0, parents]
        offsets[0] = 0.0
        return Skeleton([rename.get(name, name) for name in names], parents, offsets), positions


def walker(clip: str = "walk_straight", step: int = 2) -> Rig:
    """Return the bundled body in a bundled clip, as a rig with roles for names."""
    motion = sample(clip)[::step]
    poses = forward_kinematics(motion)
    skeleton = motion.skeleton
    rig = Rig()
    for joint, name in enumerate(skeleton.names):
        if name in ROLES:
            above = [skeleton.names[index] for index in skeleton.path_to_root(joint)[1:]]
            parent = next((ROLES[name_above] for name_above in above if name_above in ROLES), "")
            rig.parents[ROLES[name]] = parent
            rig.positions[ROLES[name]] = poses.positions[:, joint]
            rig.turns[ROLES[name]] = poses.matrices[:, joint]
    return rig


# What rigs have beside the bones of a body ------------------------------------------------------------------


def fingers(rig: Rig) -> None:
    """Add five fingers of three bones in place of one."""
    for side, sign in SIDES.items():
        rig.drop(f"{side} hand")
        for number, finger in enumerate(("thumb", "index", "middle", "ring", "little")):
            first = (0.07 * sign, 0.0, 0.02 * (2 - number))
            rig.hang_chain(f"{side} {finger}", f"{side} wrist", first, (0.03 * sign, 0.0, 0.0), 3)


def twists(rig: Rig, *, splits: bool = False) -> None:
    """Add a joint for the twist of each long bone: beside it, or within it."""
    for side in SIDES:
        for child in ("knee", "ankle", "elbow", "wrist"):
            rig.insert(f"{side} {child} twist", f"{side} {child}", splits=splits)


def split_bones(rig: Rig) -> None:
    """Split long bones in two, with a joint for the twist."""
    twists(rig, splits=True)


def muscles(rig: Rig) -> None:
    """Add helpers at all joints, for the skin of elbows and knees."""
    for side, sign in SIDES.items():
        for role in ("hip", "knee", "ankle", "shoulder", "elbow", "wrist"):
            rig.hang(f"{side} {role} roll", f"{side} {role}", (0.0, 0.0, 0.0))
            rig.hang(f"{side} {role} muscle", f"{side} {role}", (0.04 * sign, -0.05, 0.03))


def hip_bones(rig: Rig) -> None:
    """Add a joint of each side between pelvis and hip, at the pelvis."""
    for side in SIDES:
        rig.add(f"{side} hip bone", "hips", rig.positions["hips"])
        rig.parents[f"{side} hip"] = f"{side} hip bone"


def thighs_on_spine(rig: Rig) -> None:
    """Hang the thighs on the first joint of the spine, as in Biped."""
    rig.add("spine0", "hips", rig.positions["hips"] + [0.0, 0.03, 0.0])
    for name in ("left hip", "right hip", "spine1"):
        rig.parents[name] = "spine0"


def pelvis_below_hips(rig: Rig) -> None:
    """Add a pelvis for the legs, beside the spine."""
    rig.add("pelvis", "hips", rig.positions["hips"] - [0.0, 0.02, 0.0])
    for side in SIDES:
        rig.parents[f"{side} hip"] = "pelvis"


def metatarsals(rig: Rig) -> None:
    """Add a joint between ankle and ball."""
    for side in SIDES:
        rig.insert(f"{side} metatarsals", f"{side} ball", 0.4)


def heels(rig: Rig) -> None:
    """Add a joint at the heel, listed before the toes."""
    for side in SIDES:
        ankle = rig.positions[f"{side} ankle"]
        foot = rig.positions[f"{side} ball"] - ankle
        rig.add(f"{side} heel", f"{side} ankle", ankle - 0.45 * foot * [1, 0, 1] - [0.0, 0.05, 0.0])
        rig.parents[f"{side} ball"] = rig.parents.pop(f"{side} ball")


def root_and_targets(rig: Rig) -> None:
    """Add a root at the origin, with targets of inverse kinematics beside the body."""
    hips = rig.positions["hips"]
    rig.turns[""] = np.tile(np.eye(3), (len(hips), 1, 1))
    rig.parents["hips"] = "root"
    rig.add("root", "", 0 * hips)
    for side in SIDES:
        rig.add(f"ik foot {side}", "root", rig.positions[f"{side} ankle"])
        rig.add(f"ik hand {side}", "root", rig.positions[f"{side} wrist"])


def root_on_floor(rig: Rig) -> None:
    """Add a root on the floor below the hips."""
    hips = rig.positions["hips"]
    rig.turns[""] = np.tile(np.eye(3), (len(hips), 1, 1))
    rig.parents["hips"] = "reference"
    rig.add("reference", "", hips * [1, 0, 1])


def hair(rig: Rig) -> None:
    """Add three strands of hair."""
    for name, sign in (*SIDES.items(), ("back", 0)):
        rig.hang_chain(f"{name} hair", "head", (0.08 * sign, 0.08, -0.1), (0.0, -0.15, 0.0), 6)


def skirt(rig: Rig) -> None:
    """Add eight chains around the hips."""
    for number, angle in enumerate(np.arange(8) * np.pi / 4):
        first = (0.1 * np.sin(angle), 0.0, 0.1 * np.cos(angle))
        rig.hang_chain(f"skirt {number}", "hips", first, (0.0, -0.12, 0.0), 4)


def coat(rig: Rig) -> None:
    """Add two tails of a coat, as long as arms."""
    for side, sign in SIDES.items():
        rig.hang_chain(f"{side} coat", "spine3", (0.12 * sign, 0.0, -0.12), (0.0, -0.28, 0.0), 4)


def wings(rig: Rig) -> None:
    """Add two wings, longer than arms."""
    for side, sign in SIDES.items():
        rig.hang_chain(f"{side} wing", "spine3", (0.05 * sign, 0.1, -0.1), (0.4 * sign, 0.1, 0.0), 4)


def tail(rig: Rig) -> None:
    """Add a tail."""
    rig.hang_chain("tail", "hips", (0.0, -0.02, -0.12), (0.0, -0.02, -0.12), 6)


def sword(rig: Rig) -> None:
    """Add a sword in the right hand."""
    rig.hang_chain("sword", "right wrist", (-0.05, 0.0, 0.05), (0.0, 0.0, 0.9), 2)


def two_props(rig: Rig) -> None:
    """Add a stick in each hand, as long as a ski pole."""
    for side, sign in SIDES.items():
        rig.hang_chain(f"{side} pole", f"{side} wrist", (0.08 * sign, 0.0, 0.03), (0.0, -0.55, 0.3), 2)


def held(joint: str, *bones: Vector) -> Change:
    """Fix a rigid thing on a joint of both sides: offsets of its bones on the left, each below the last."""

    def change(rig: Rig) -> None:
        for side, sign in SIDES.items():
            parent = f"{side} {joint}"
            for number, bone in enumerate(bones):
                name = f"{side} held by {joint} {number}"
                offset = np.multiply(bone, (sign, 1.0, 1.0)).tolist()
                rig.hang(name, parent, offset)
                parent = name

    return change


skis = held("ankle", (0.0, -0.08, 0.0), (0.0, 0.0, 0.8))
stilts = held("ankle", (0.0, -0.05, 0.0), (0.0, -0.4, 0.0))
swords = held("wrist", (0.05, 0.0, 0.05), (0.0, 0.0, 0.9))
shields = held("elbow", (0.0, 0.0, 0.1), (0.0, -0.35, 0.0))
guards = held("knee", (0.0, 0.0, 0.1), (0.0, -0.6, 0.0))
rigid_wings = held("clavicle", (0.0, 0.1, -0.1), (0.7, 0.1, 0.0))


def skis_of_two(rig: Rig) -> None:
    """Add skis whose fronts and backs both hang on the ankle."""
    for side in SIDES:
        for end, ahead in (("front", 0.4), ("back", -0.4)):
            rig.hang(f"{side} ski, {end}", f"{side} ankle", (0.0, -0.08, ahead))


def five_toes(rig: Rig) -> None:
    """Add five toes of two bones in place of the tip of the foot."""
    for side, sign in SIDES.items():
        rig.drop(f"{side} tip")
        for number in range(5):
            first = (0.02 * sign * (number - 2), -0.01, 0.05 - 0.006 * number)
            rig.hang_chain(f"{side} toe {number}", f"{side} ball", first, (0.0, 0.0, 0.02), 2)


def face(rig: Rig) -> None:
    """Add eyes and a jaw."""
    for side, sign in SIDES.items():
        rig.hang(f"{side} eye", "head", (0.03 * sign, 0.06, 0.08))
    rig.hang_chain("jaw", "head", (0.0, 0.0, 0.03), (0.0, -0.04, 0.05), 2)


def face_root(rig: Rig) -> None:
    """Add a joint at the head on which eyes, a jaw and the top of the head hang."""
    rig.add("face", "head", rig.positions["head"])
    rig.parents["top"] = "face"
    for name, offset in (("left eye", (0.03, 0.08, 0.08)), ("jaw", (0.0, 0.0, 0.05))):
        rig.hang(name, "face", offset)


def stiff_palms(rig: Rig) -> None:
    """Add three bones of the palm in line with the forearm, with long fingers, to hands that never bend."""
    for side in SIDES:
        rig.drop(f"{side} hand")
        wrist = rig.positions[f"{side} wrist"]
        rig.turns[f"{side} wrist"] = rig.turns[f"{side} elbow"]
        forearm = wrist[0] - rig.positions[f"{side} elbow"][0]
        along = rig.turns[f"{side} wrist"][0].T @ forearm / np.linalg.norm(forearm)
        for number, length in enumerate((0.045, 0.05, 0.045)):
            first = length * along + [0.0, 0.0, 0.01 * (number - 1)]
            rig.hang_chain(f"{side} palm {number}", f"{side} wrist", tuple(first), tuple(0.06 * along), 4)


def kneecaps(rig: Rig) -> None:
    """Add a helper in front of each knee and behind each elbow, with a tip."""
    for side in SIDES:
        for role, ahead in (("knee", 0.06), ("elbow", -0.04)):
            rig.hang_chain(f"{side} {role} helper", f"{side} {role}", (0.0, 0.0, ahead), (0.0, 0.0, 0.03), 2)


def cape(rig: Rig) -> None:
    """Add a cape of three chains that nearly reach the floor, listed before the arms."""
    arms = {name: rig.parents.pop(f"{name}") for name in ("left clavicle", "right clavicle")}
    for number, across in enumerate((-0.15, 0.0, 0.15)):
        rig.hang_chain(f"cape {number}", "spine3", (across, 0.05, -0.14), (0.0, -0.24, -0.02), 5)
    rig.parents |= arms


def backpack(rig: Rig) -> None:
    """Add a backpack with two straps."""
    rig.hang_chain("pack", "spine3", (0.0, 0.0, -0.2), (0.0, -0.3, 0.0), 2)
    for side, sign in SIDES.items():
        rig.hang_chain(f"{side} strap", "spine3", (0.14 * sign, 0.1, 0.1), (0.0, -0.2, 0.0), 2)


def spine_of_many(rig: Rig) -> None:
    """Split each bone of the spine and of the neck in three."""
    for child in ("spine1", "spine2", "spine3", "neck1", "neck2"):
        rig.insert(f"{child} a", child, 0.33)
        rig.insert(f"{child} b", child, 0.5)


def hinges(rig: Rig) -> None:
    """Add hinges below hips and shoulders, as in robots."""
    for side in SIDES:
        for role, child in (("hip", "knee"), ("shoulder", "elbow")):
            for axis in ("y", "z"):
                rig.insert(f"{side} {role} {axis}", f"{side} {child}", 0.0)


def without(*roles: str) -> Change:
    """Leave out joints, those of both sides."""

    def change(rig: Rig) -> None:
        for name in [name for name in rig.parents if name.split()[-1] in roles]:
            rig.drop(name)

    return change


def flat_toes(rig: Rig) -> None:
    """Put the toes at the ankles, without a length."""
    without("tip")(rig)
    for side in SIDES:
        rig.positions[f"{side} ball"] = rig.positions[f"{side} ankle"]


def noise(rig: Rig) -> None:
    """Add noise of 1 cm to each joint, as in bodies estimated from video."""
    chance = np.random.default_rng(0)
    rig.positions = {
        name: places + chance.normal(0, 0.01, places.shape) for name, places in rig.positions.items()
    }


def backwards(rig: Rig) -> None:
    """Run the clip backwards."""
    rig.positions = {name: places[::-1] for name, places in rig.positions.items()}


def one_frame(rig: Rig) -> None:
    """Take a single pose of the clip."""
    rig.positions = {name: places[40:41] for name, places in rig.positions.items()}


# Schemes ----------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Scheme:
    """The names of a side's joints, and what the rig has beside them.

    Parameters
    ----------
    leg : names of hip, knee, ankle and ball, with {} for the side; several words in a name are joined by ~.
    arm : names of shoulder, elbow and wrist.
    sides : what {} is on the left and on the right.
    changes : of the rig.
    """

    leg: str
    arm: str
    sides: str
    changes: tuple[Change, ...] = ()

    def names(self) -> dict[str, str]:
        """Return the names of the joints of both sides by role."""
        words = [*self.leg.split(), *self.arm.split()]
        patterns = dict(zip([*LEG[:4], *ARM[1:4]], words, strict=True))
        names = {}
        for side, spelling in zip(SIDES, self.sides.split(), strict=True):
            for role, pattern in patterns.items():
                names[f"{side} {role}"] = pattern.replace("{}", spelling).replace("~", " ")
        return names


WORDS = "Left Right"
SMALL_WORDS = "left right"
CAPITALS = "L R"
LETTERS = "l r"
# Names of a human body in MotionBuilder, which many schemes repeat with a prefix.
MB_LEG = "{}UpLeg {}Leg {}Foot {}ToeBase"
MB_ARM = "{}Arm {}ForeArm {}Hand"


def prefixed(prefix: str, names: str) -> str:
    """Write a prefix before each name."""
    return " ".join(f"{prefix}{name}" for name in names.split())


BIPED_LEG = "{}_Thigh {}_Calf {}_Foot {}_Toe0"
BIPED_ARM = "{}_UpperArm {}_Forearm {}_Hand"
SPLIT = (split_bones, fingers)
# reads: statement: a table
SCHEMES: dict[str, Scheme] = {
    "CMU, Acclaim": Scheme(
        "{}femur {}tibia {}foot {}toes", "{}humerus {}radius {}wrist", LETTERS, (hip_bones,)
    ),
    "HDM05": Scheme(
        "{}femur {}tibia {}foot {}toes", "{}humerus {}radius {}hand", LETTERS, (hip_bones, without("tip"))
    ),
    "MotionBuilder": Scheme(MB_LEG, MB_ARM, WORDS, (fingers,)),
    "MotionBuilder, Character1_": Scheme(
        prefixed("Character1_", MB_LEG), prefixed("Character1_", MB_ARM), WORDS, (root_on_floor, muscles)
    ),
    "Mixamo, colon": Scheme(
        prefixed("mixamorig:", MB_LEG), prefixed("mixamorig:", MB_ARM), WORDS, (fingers,)
    ),
    "Mixamo, number": Scheme(
        prefixed("mixamorig7:", MB_LEG), prefixed("mixamorig7:", MB_ARM), WORDS, (fingers,)
    ),
    "Mixamo, underscore": Scheme(
        prefixed("mixamorig_", MB_LEG), prefixed("mixamorig_", MB_ARM), WORDS, (fingers,)
    ),
    "Mixamo, three.js": Scheme(
        prefixed("mixamorig", MB_LEG), prefixed("mixamorig", MB_ARM), WORDS, (fingers,)
    ),
    "LAFAN1": Scheme("{}UpLeg {}Leg {}Foot {}Toe", MB_ARM, WORDS, (without("tip", "hand", "top", "neck2"),)),
    "PFNN": Scheme(MB_LEG, MB_ARM, WORDS, (hip_bones, without("tip", "top"))),
    "Perception Neuron": Scheme("{}UpLeg {}Leg {}Foot {}Foot_End", MB_ARM, WORDS, (without("tip"), fingers)),
    "SOMA, BONES-SEED": Scheme("{}Leg {}Shin {}Foot {}ToeBase", MB_ARM, WORDS, (fingers,)),
    "100STYLE": Scheme("{}Hip {}Knee {}Ankle {}Toe", "{}Shoulder {}Elbow {}Wrist", WORDS),
    "Xsens MVN": Scheme(
        "{}UpperLeg {}LowerLeg {}Foot {}Toe", "{}UpperArm {}ForeArm {}Hand", WORDS, (without("tip", "hand"),)
    ),
    "Rokoko": Scheme("{}Thigh {}Shin {}Foot {}Toe", MB_ARM, WORDS, (fingers, without("neck2"))),
    "Unreal mannequin": Scheme(
        "thigh_{} calf_{} foot_{} ball_{}",
        "upperarm_{} lowerarm_{} hand_{}",
        LETTERS,
        (without("tip"), fingers, twists, root_and_targets),
    ),
    "3ds Max Biped, spaces": Scheme(
        prefixed("Bip01~", BIPED_LEG.replace("_", "~")),
        prefixed("Bip01~", BIPED_ARM.replace("_", "~")),
        CAPITALS,
        (thighs_on_spine, fingers),
    ),
    "3ds Max Biped, underscores": Scheme(
        prefixed("Bip01_", BIPED_LEG), prefixed("Bip01_", BIPED_ARM), CAPITALS, (thighs_on_spine, fingers)
    ),
    "Source engine": Scheme(
        prefixed("ValveBiped.Bip01_", BIPED_LEG),
        prefixed("ValveBiped.Bip01_", BIPED_ARM),
        CAPITALS,
        (fingers,),
    ),
    "Truebones": Scheme(
        "BN_{}_Thigh BN_{}_Calf BN_{}_Foot BN_{}_Toe",
        "BN_{}_UpperArm BN_{}_Forearm BN_{}_Hand",
        CAPITALS,
        (thighs_on_spine, tail, fingers),
    ),
    "Rigify, DEF": Scheme(
        "DEF-thigh.{} DEF-shin.{} DEF-foot.{} DEF-toe.{}",
        "DEF-upper_arm.{} DEF-forearm.{} DEF-hand.{}",
        CAPITALS,
        (split_bones, heels, fingers),
    ),
    "Rigify metarig, FreeMoCap": Scheme(
        "thigh.{} shin.{} foot.{} toe.{}", "upper_arm.{} forearm.{} hand.{}", CAPITALS, (heels, fingers)
    ),
    "Maya, _L": Scheme("Thigh_{} Shin_{} Foot_{} Toe_{}", "UpperArm_{} ForeArm_{} Hand_{}", CAPITALS),
    "Bandai Namco": Scheme(
        "UpperLeg_{} LowerLeg_{} Foot_{} Toes_{}",
        "UpperArm_{} LowerArm_{} Hand_{}",
        CAPITALS,
        (without("tip"),),
    ),
    "Unity humanoid": Scheme(
        "{}~UpperLeg {}~LowerLeg {}~Foot {}~Toes",
        "{}~UpperArm {}~LowerArm {}~Hand",
        WORDS,
        (fingers, without("neck2")),
    ),
    "VRM": Scheme(
        "{}UpperLeg {}LowerLeg {}Foot {}Toes",
        "{}UpperArm {}LowerArm {}Hand",
        SMALL_WORDS,
        (fingers, hair, skirt),
    ),
    "VRoid": Scheme(
        "J_Bip_{}_UpperLeg J_Bip_{}_LowerLeg J_Bip_{}_Foot J_Bip_{}_ToeBase",
        "J_Bip_{}_UpperArm J_Bip_{}_LowerArm J_Bip_{}_Hand",
        CAPITALS,
        (fingers, hair, skirt),
    ),
    "Daz Genesis 8": Scheme(
        "{}ThighBend {}Shin {}Foot {}Metatarsals",
        "{}ShldrBend {}ForearmBend {}Hand",
        LETTERS,
        (split_bones, metatarsals, pelvis_below_hips, fingers),
    ),
    "Daz Genesis 9": Scheme(
        "{}_thigh {}_shin {}_foot {}_toes", "{}_upperarm {}_forearm {}_hand", LETTERS, (twists, fingers)
    ),
    "Poser": Scheme("{}Thigh {}Shin {}Foot {}Toe", "{}Shldr {}ForeArm {}Hand", LETTERS, (fingers,)),
    "Second Life": Scheme(
        "mHip{} mKnee{} mAnkle{} mFoot{}", "mShoulder{} mElbow{} mWrist{}", WORDS, (fingers,)
    ),
    "SMPL": Scheme(
        "{}_Hip {}_Knee {}_Ankle {}_Foot",
        "{}_Shoulder {}_Elbow {}_Wrist",
        CAPITALS,
        (without("tip", "top", "neck2"),),
    ),
    "SMPL in Maya": Scheme(
        "m_avg_{}_Hip m_avg_{}_Knee m_avg_{}_Ankle m_avg_{}_Foot",
        "m_avg_{}_Shoulder m_avg_{}_Elbow m_avg_{}_Wrist",
        CAPITALS,
        (without("tip", "top", "neck2"),),
    ),
    "SMPL-X": Scheme(
        "{}_hip {}_knee {}_ankle {}_foot",
        "{}_shoulder {}_elbow {}_wrist",
        SMALL_WORDS,
        (without("tip", "top", "neck2"), fingers),
    ),
    "ARKit": Scheme(
        "{}_upLeg_joint {}_leg_joint {}_foot_joint {}_toes_joint",
        "{}_arm_joint {}_forearm_joint {}_hand_joint",
        SMALL_WORDS,
        (fingers,),
    ),
    "Character Creator": Scheme(
        prefixed("CC_Base_", "{}_Thigh {}_Calf {}_Foot {}_ToeBase"),
        prefixed("CC_Base_", "{}_Upperarm {}_Forearm {}_Hand"),
        CAPITALS,
        (twists, muscles, fingers, pelvis_below_hips),
    ),
    "MocapNET": Scheme("{}hip {}knee {}foot toe1-1.{}", "{}shoulder {}elbow {}hand", LETTERS, (fingers,)),
    "MakeHuman, default": Scheme(
        "upperleg01.{} lowerleg01.{} foot.{} toe1-1.{}",
        "upperarm01.{} lowerarm01.{} wrist.{}",
        CAPITALS,
        SPLIT,
    ),
    "MakeHuman, BVH": Scheme("UpLeg_{} LoLeg_{} Foot_{} Toe_{}", "UpArm_{} LoArm_{} Hand_{}", CAPITALS),
    "Kinect": Scheme(
        "Hip{} Knee{} Ankle{} Foot{}",
        "Shoulder{} Elbow{} Wrist{}",
        WORDS,
        (without("tip", "clavicle", "neck2", "top"),),
    ),
    "OpenPose": Scheme(
        "{}Hip {}Knee {}Ankle {}BigToe",
        "{}Shoulder {}Elbow {}Wrist",
        CAPITALS,
        (without("tip", "clavicle", "hand", "top"), heels),
    ),
    "OptiTrack": Scheme("{}Thigh {}Shin {}Foot {}Toe", "{}UArm {}FArm {}Hand", CAPITALS, (fingers,)),
    "MikuMikuDance": Scheme(
        "{}足 {}ひざ {}足首 {}つま先", "{}腕 {}ひじ {}手首", "左 右", (split_bones, hair)
    ),
}

# reads: statement: a table
ODDITIES: dict[str, tuple[Change, ...]] = {
    "numbers for names": (fingers, twists, muscles),
    "split bones": (fingers, split_bones),
    "toes without a length": (flat_toes,),
    "no toes": (without("ball", "tip"),),
    "heels before toes": (heels,),
    "a sword": (fingers, sword),
    "long hair": (hair,),
    "a skirt and hair": (skirt, hair),
    "two coat-tails": (coat,),
    "wings": (wings,),
    "a tail": (tail,),
    "no forearms": (without("hand", "wrist", "clavicle"),),
    "no head": (without("head", "top", "neck1", "neck2"),),
    "only legs": (without(*ARM, "spine1", "spine2", "spine3", "neck1", "neck2", "head", "top"),),
    "a root and targets": (root_and_targets,),
    "three hinges at a hip": (hinges,),
    "noise of 1 cm": (noise,),
    "a clip run backwards": (fingers, backwards),
    "one frame": (fingers, one_frame),
    "poles in both hands": (two_props,),
    "skis": (skis,),
    "skis on feet without toes": (without("ball", "tip"), skis),
    "skis on the balls of the feet": (held("ball", (0.0, -0.03, 0.0), (0.0, 0.0, 0.8)),),
    "skis of two halves": (skis_of_two,),
    "skis and poles": (skis, two_props),
    "stilts": (stilts,),
    "two swords": (swords,),
    "two shields on the forearms": (shields,),
    "long guards on the shanks": (guards,),
    "rigid wings": (rigid_wings,),
    "five toes on each foot": (five_toes,),
    "eyes and a jaw": (face,),
    "a joint for the face": (face_root,),
    "palms of stiff hands": (stiff_palms,),
    "helpers at knees and elbows": (kneecaps,),
    "a cape": (cape,),
    "a backpack": (backpack,),
    "a spine of many bones": (spine_of_many,),
}

# reads: statement: a table
KINDS: dict[str, Change] = {
    "fingers": fingers,
    "twists": twists,
    "split bones": split_bones,
    "muscles": muscles,
    "hip bones": hip_bones,
    "thighs on spine": thighs_on_spine,
    "pelvis below hips": pelvis_below_hips,
    "metatarsals": metatarsals,
    "heels": heels,
    "targets": root_and_targets,
    "root on floor": root_on_floor,
    "hair": hair,
    "skirt": skirt,
    "coat": coat,
    "wings": wings,
    "tail": tail,
    "sword": sword,
    "poles": two_props,
    "swords": swords,
    "skis": skis,
    "stilts": stilts,
    "shields": shields,
    "guards": guards,
    "face": face,
    "kneecaps": kneecaps,
    "cape": cape,
    "backpack": backpack,
    "long spine": spine_of_many,
    "hinges": hinges,
    "five toes": five_toes,
    "flat toes": flat_toes,
    "no toes": without("ball", "tip"),
    "backwards": backwards,
    "noise": noise,
}
"""Changes that may be made to one rig, in this order."""
EXCLUSIVE = (
    {"metatarsals", "five toes", "flat toes", "no toes"},
    {"heels", "flat toes", "no toes"},
    {"twists", "split bones"},
    {"targets", "root on floor"},
    {"hip bones", "thighs on spine", "pelvis below hips"},
    {"sword", "poles", "swords"},
    {"skis", "stilts"},
    {"hinges", "noise"},  # which of several joints in one place is the hip, noise hides
)
"""Kinds of which a rig has at most one."""


# The table --------------------------------------------------------------------------------------------------


def scheme_rig(scheme: Scheme, clip: str = "walk_straight") -> tuple[Rig, dict[str, str]]:
    """Make a scheme's rig, and the names of its joints: those of the scheme, and numbers for all others."""
    rig = odd_rig(scheme.changes, clip)
    numbers = {name: f"joint{number}" for number, name in enumerate(rig.names())}
    return rig, numbers | {role: name for role, name in scheme.names().items() if role in rig.parents}


def odd_rig(changes: Sequence[Change], clip: str = "walk_straight") -> Rig:
    """Make a rig with changes."""
    rig = walker(clip)
    for change in changes:
        change(rig)
    return rig


def expected_roles(rig: Rig) -> dict[str, str]:
    """Return the joints of a rig by role; the first joint ahead of an ankle is its ball."""
    roles = {name: name for name in rig.parents if name.split()[-1] in COMPARED}
    for side in SIDES:
        ball = f"{side} ball"
        if f"{side} metatarsals" in rig.parents:
            roles[ball] = f"{side} metatarsals"
        if f"{side} toe 0 1" in rig.parents:
            roles[f"{side} tip"] = f"{side} toe 0 1"  # the big toe
        if ball in roles and rig.has_flat_toes():
            roles.pop(ball)
        if not {f"{side} {role}" for role in ARM[1:4]} <= roles.keys():
            roles = {role: name for role, name in roles.items() if role.split()[1] not in ARM}
    return roles


def found_roles(rig: Rig, limbs: FoundLimbs) -> dict[str, str]:
    """Return the names in a rig of the joints that were found, for the roles of `expected_roles`."""
    names = rig.names()
    return {role: names[joint] for role, joint in limbs.roles.items() if role.split()[-1] in COMPARED}


def random_names(rig: Rig, seed: int) -> dict[str, str]:
    """Give all joints of a rig random names of twelve letters."""
    return dict(zip(rig.parents, random_words(len(rig.parents), seed), strict=True))


def random_words(count: int, seed: int) -> list[str]:
    """Return random words of twelve letters."""
    chance = np.random.default_rng(seed)
    letters = chance.integers(ord("a"), ord("z") + 1, (count, 12))
    return ["".join(map(chr, row)) for row in letters]


def wrong_roles(rig: Rig, limbs: FoundLimbs) -> list[str]:
    """List the roles that are missing, of another joint, or too many."""
    expected = expected_roles(rig)
    roles = found_roles(rig, limbs)
    return sorted(role for role in expected | roles if expected.get(role) != roles.get(role))


def rigs(clip: str) -> dict[str, tuple[Rig, dict[str, str]]]:
    """Make the rigs of all schemes and oddities, with their names."""
    bodies = {name: scheme_rig(scheme, clip) for name, scheme in SCHEMES.items()}
    for name, changes in ODDITIES.items():
        rig = odd_rig(changes, clip)
        bodies[name] = (rig, {joint: f"joint{number}" for number, joint in enumerate(rig.names())})
    return bodies


def print_table(clip: str) -> None:
    """Print a line for each scheme and oddity: how many joints, whether all roles are right, and doubts."""
    print(f"{'scheme':<28} {'joints':>6} {'ms':>4}  wrong; doubts")
    right = 0
    bodies = rigs(clip)
    for name, (rig, names) in bodies.items():
        skeleton, positions = rig.skeleton(names)
        start = time.perf_counter()
        limbs = find_limbs(skeleton, positions)
        milliseconds = 1000 * (time.perf_counter() - start)
        wrong = wrong_roles(rig, limbs)
        right += not wrong
        notes = "; ".join([", ".join(wrong) or "none", *limbs.doubts])
        print(f"{name:<28} {len(skeleton):>6} {milliseconds:>4.0f}  {notes}")
    print(f"{right} of {len(bodies)} right: {len(SCHEMES)} schemes, {len(ODDITIES)} oddities")


def print_limits(clip: str) -> None:
    """Print how many rigs have a wrong role with each limit of the search halved and doubled."""
    bodies = [(rig, *rig.skeleton(names)) for rig, names in rigs(clip).values()]
    print(f"{'limit':<28} {'halved':>6} {'doubled':>7}  of {len(bodies)} rigs with a wrong role")
    for modules in ((limb_pairs, limb_roles, limb_search), (limb_tree,)):
        usual = modules[0].LIMITS
        for limit in fields(usual):
            value = getattr(usual, limit.name)
            counts = []
            for factor in (0.5, 2.0):
                changed = replace(usual, **{limit.name: type(value)(factor * value)})
                set_limits(modules, changed)
                counts.append(sum(bool(wrong_roles(rig, find_limbs(*body))) for rig, *body in bodies))
            set_limits(modules, usual)
            print(f"{limit.name:<28} {counts[0]:>6} {counts[1]:>7}")


def set_limits(modules: Iterable[ModuleType], limits: object) -> None:
    """Set the limits of the search in each of its modules."""
    for module in modules:
        module.LIMITS = limits


def mixed_kinds(seed: int, count: int = 3) -> list[str]:
    """Choose some kinds of changes that fit together at random."""
    chance = np.random.default_rng(seed)
    while True:
        numbers = sorted(chance.choice(len(KINDS), count, replace=False).tolist())
        kinds = [list(KINDS)[number] for number in numbers]
        if all(len(group.intersection(kinds)) < 2 for group in EXCLUSIVE):
            return kinds


def mixed_rig(seed: int) -> tuple[list[str], Rig]:
    """Make a rig with three kinds of changes, from a bundled clip, both chosen at random."""
    kinds = mixed_kinds(seed)
    return kinds, odd_rig([KINDS[kind] for kind in kinds], SAMPLES[seed % len(SAMPLES)])


def print_mixed(count: int) -> None:
    """Print the mixed rigs that have a wrong role, and how many are right and doubtful."""
    outcomes: Counter[str] = Counter()
    for seed in range(count):
        kinds, rig = mixed_rig(seed)
        limbs = find_limbs(*rig.skeleton(random_names(rig, seed)))
        wrong = wrong_roles(rig, limbs)
        doubt = "in doubt" if limbs.doubts else "without a doubt"
        outcomes[f"{'wrong' if wrong else 'right'}, {doubt}"] += 1
        if wrong:
            doubts = "; ".join(limbs.doubts) or "SILENT"
            print(f"{seed:>4} {', '.join(kinds):<40} {', '.join(wrong)}; {doubts}")
    counts = [f"{number} {outcome}" for outcome, number in outcomes.items()]
    print(f"of {count} rigs:", ", ".join(counts))


def print_renamed(folder: Path) -> None:
    """Print how often random names change a role in the clips of a folder, and what is doubtful."""
    changed = tried = 0
    doubtful: list[str] = []
    for path in find_files([folder]):
        try:
            motion = read(path, None, None, None, np.inf).motion
        except MocapError as error:
            print(f"{path}: {error}")
            continue
        limbs = find_limbs(motion.skeleton, motion.positions)
        doubtful += [f"{path}: {'; '.join(limbs.doubts)}"] if limbs.doubts else []
        for seed in range(3):
            names = random_words(len(motion.skeleton), seed)
            anonymous = replace(motion.skeleton, names=names, roles={})
            tried += 1
            if find_limbs(anonymous, motion.positions).roles != limbs.roles:
                changed += 1
                print(f"{path}: names of seed {seed} change a role")
    print("\n".join(doubtful))
    print(f"{changed} of {tried} renamed clips have other roles; {len(doubtful)} clips are in doubt")


def main() -> None:
    """Print the table that the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--clip", default="walk_straight", help="a bundled clip")
    parser.add_argument("--limits", action="store_true", help="vary the limits of the search")
    parser.add_argument("--mixed", type=int, metavar="N", help="N rigs of three kinds at a time")
    parser.add_argument("--files", type=Path, metavar="FOLDER", help="rename the joints of captured clips")
    options = parser.parse_args()
    warnings.simplefilter("ignore", MocapWarning)
    if options.limits:
        print_limits(options.clip)
    elif options.mixed:
        print_mixed(options.mixed)
    elif options.files:
        print_renamed(options.files)
    else:
        print_table(options.clip)


if __name__ == "__main__":
    main()
