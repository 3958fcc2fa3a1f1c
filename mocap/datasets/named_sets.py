"""Sets of clips that other labs share, from a copy of your own: Bandai-Namco, LAFAN1, 100STYLE.

They come as archives of many `.bvh` files, under licences that each user must accept. So nothing is
downloaded here: unpack an archive into a folder of the set's name, in the folder that the environment
variable `MOCAP_DATA` names, or in the cache of this package.
"""

from __future__ import annotations

import hashlib
import os
import sys
from functools import cache
from pathlib import Path
from typing import NamedTuple

from mocap.body.limbs import Leg, name_leg
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError, shortened
from mocap.files.load_save import load


class NamedSet(NamedTuple):
    """A set of clips: its licence, where it can be had, and which joints its feet and hips are.

    `legs` names the hip, knee, ankle and ball of the left leg; with right for left, those of the right one.
    """

    title: str
    licence: str
    address: str
    fps: float
    hips: str
    legs: tuple[str, str, str, str]

    def find_legs(self, skeleton: Skeleton) -> tuple[Leg, Leg]:
        """Give the left and the right leg of a body of this set."""
        left, right = self.legs, [_right(name) for name in self.legs]
        return name_leg(skeleton, *left), name_leg(skeleton, *right)

    def terms(self) -> str:
        """Say under which licence the clips are, and whose they are."""
        return f"These clips come from {self.title} ({self.address}), under {self.licence}."


def _right(name: str) -> str:
    return name.replace("Left", "Right").replace("_L", "_R")


SETS = {
    "bandai_namco": NamedSet(
        "the Bandai-Namco-Research-Motiondataset",
        "CC BY-NC 4.0 (earlier versions: CC BY-NC-ND 4.0)",
        "github.com/BandaiNamcoResearchInc/Bandai-Namco-Research-Motiondataset",
        30.0,
        "Hips",
        ("UpperLeg_L", "LowerLeg_L", "Foot_L", "Toes_L"),
    ),
    "lafan1": NamedSet(
        "the Ubisoft La Forge Animation Dataset, LAFAN1",
        "CC BY-NC-ND 4.0",
        "github.com/ubisoft/ubisoft-laforge-animation-dataset",
        30.0,
        "Hips",
        ("LeftUpLeg", "LeftLeg", "LeftFoot", "LeftToe"),
    ),
    "100style": NamedSet(
        "the 100STYLE dataset by Ian Mason",
        "CC BY 4.0",
        "zenodo.org/records/8127870",
        60.0,
        "Hips",
        ("LeftHip", "LeftKnee", "LeftAnkle", "LeftToe"),
    ),
}
"""The sets by the names of their folders."""

HASHES = {
    "dataset-1_run_normal_001": "93cbc794bf178ce7d98a1a95efdee52699b4c0cdfcd9ec619f7ae9ec7bda024f",
    "dataset-1_walk_normal_001": "5764cebc2fedabf287880a7f25cb06753e1679675a02a6f033998de041ba8032",
    "dataset-2_walk-turn-left_normal_001": "6cd20145fc1544db244217a3be171fc4bbdfb6ce7894c08249cda589b28fb761",
    "dataset-2_walk-turn-right_normal_001": "9bd51f35392773dec98fbc78a0277015106f4f397ad96b984536c1e5472d2bc8",  # noqa: E501
    "dataset-2_walk_elderly_001": "9cbe9c02a9767aeb913d9bc83deb627cd7bc2c5edc78d73b1aa22ee8fb5f06b9",
    "dataset-2_walk_normal_001": "30aa8c9251ffdaa9c3ed416953d4e4154ad4132e607987231ea02ad2fde9672d",
}
"""SHA-256 of the files that were at hand; the others are read as they are."""


def folder_of(name: str) -> Path:
    """Give the folder in which a set is looked for.

    Raises
    ------
    MocapError : for an unknown set.

    Examples
    --------
    >>> folder_of("lafan1").name
    'lafan1'
    >>> folder_of("amass")
    Traceback (most recent call last):
    mocap.errors.MocapError: No set 'amass' is known; there are: bandai_namco, lafan1, 100style.
    """
    if name not in SETS:
        raise MocapError(f"No set '{shortened(name, 40)}' is known; there are: {', '.join(SETS)}.")
    if os.environ.get("MOCAP_DATA"):
        return Path(os.environ["MOCAP_DATA"]) / name
    import pooch

    return Path(pooch.os_cache("mocap")) / name


def list_set(name: str) -> list[str]:
    """List the clips of a set that are at hand, by their files' names.

    Raises
    ------
    MocapError : for an unknown set.
    """
    return sorted(path.stem for path in folder_of(name).rglob("*.bvh"))


def from_set(name: str, clip: str) -> Motion:
    """Read a clip of a named set from your own copy; its terms are printed once.

    Parameters
    ----------
    name : the set, one of `SETS`, such as "lafan1".
    clip : the name of a file, such as "walk1_subject1"; it may lie in any folder of the set.

    Raises
    ------
    MocapError : for an unknown set, a clip that is not there, with where to get it and where to put it, and a
        file that is not the one listed.

    Examples
    --------
    >>> from_set("100style", "Nobody_FW")
    Traceback (most recent call last):
    mocap.errors.MocapError: No clip 'Nobody_FW' ...: get the set at zenodo.org/records/8127870 ...
    """
    folder, known = folder_of(name), SETS[name]
    found = sorted(path for path in folder.rglob("*.bvh") if path.stem == clip)
    if not found:
        raise MocapError(
            f"No clip '{shortened(clip, 40)}' in {folder}: get the set at {known.address} ({known.licence}), "
            "and unpack it there."
        )
    if clip in HASHES and hashlib.sha256(found[0].read_bytes()).hexdigest() != HASHES[clip]:
        raise MocapError(f"{found[0]} is not the file listed: its checksum differs. Get it anew.")
    _show(known.terms())
    return load(found[0])


@cache
def _show(terms: str) -> None:
    print(terms, file=sys.stderr)
