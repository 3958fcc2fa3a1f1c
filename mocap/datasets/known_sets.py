"""What is known of each named set: its licence, where it is, and which joints its hips and legs are."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from mocap.errors import MocapError, shortened

if TYPE_CHECKING:
    from mocap.body.limbs import Leg
    from mocap.body.skeleton import Skeleton


class Archive(NamedTuple):
    """A .zip of all clips: its address, its size in megabytes, and its SHA-256 where it is known."""

    url: str
    megabytes: int | None = None
    sha256: str | None = None


class NamedSet(NamedTuple):
    """A set of clips: its licence and what that allows, where it is, and which joints feet and hips are.

    `legs` names the hip, knee, ankle and ball of the left leg; with right for left, those of the right one.
    `clip_url` is where a single clip is, with `{part}` and `{clip}` to be filled in, if it can be had alone.
    """

    title: str
    licence: str
    allows: str
    address: str
    archive: Archive
    fps: float
    hips: str
    legs: tuple[str, str, str, str]
    clip_url: str = ""

    def find_legs(self, skeleton: Skeleton) -> tuple[Leg, Leg]:
        """Give the left and the right leg of a body of this set."""
        from mocap.body.limbs import name_leg  # the command line lists the sets without numpy

        left, right = self.legs, [_right(name) for name in self.legs]
        return name_leg(skeleton, *left), name_leg(skeleton, *right)

    def terms(self) -> str:
        """Say whose clips they are, under which licence, and what that allows."""
        return f"These clips come from {self.title} ({self.address}), under {self.licence}: {self.allows}."

    def size(self) -> str:
        """Say how large the archive is."""
        return f"{self.archive.megabytes} MB" if self.archive.megabytes else "some hundred MB"


def _right(name: str) -> str:
    return name.replace("Left", "Right").replace("_L", "_R")


_GITHUB = "BandaiNamcoResearchInc/Bandai-Namco-Research-Motiondataset"

# LAFAN1's checksum stands in its repository, as the pointer of Git LFS. Two projects that use 100STYLE
# publish the same one for it. GitHub packs Bandai-Namco's archive anew, so that has none.
SETS = {
    "bandai_namco": NamedSet(
        "the Bandai-Namco-Research-Motiondataset",
        "CC BY-NC 4.0 (earlier versions: CC BY-NC-ND 4.0)",
        "free with the authors' names, but not for commercial use",
        f"github.com/{_GITHUB}",
        Archive(f"https://github.com/{_GITHUB}/archive/refs/heads/master.zip"),
        30.0,
        "Hips",
        ("UpperLeg_L", "LowerLeg_L", "Foot_L", "Toes_L"),
        f"https://raw.githubusercontent.com/{_GITHUB}/master/dataset/"
        "Bandai-Namco-Research-Motiondataset-{part}/data/{clip}.bvh",
    ),
    "lafan1": NamedSet(
        "the Ubisoft La Forge Animation Dataset, LAFAN1",
        "CC BY-NC-ND 4.0",
        "free with the authors' names, but not for commercial use, nor to share what you make of them",
        "github.com/ubisoft/ubisoft-laforge-animation-dataset",
        Archive(
            "https://media.githubusercontent.com/media/ubisoft/ubisoft-laforge-animation-dataset/"
            "master/lafan1/lafan1.zip",
            144,
            "ea918082b500a5d158e9d3aa39039df04cd42e25f5c02fe8f7e88e8e9365a977",
        ),
        30.0,
        "Hips",
        ("LeftUpLeg", "LeftLeg", "LeftFoot", "LeftToe"),
    ),
    "100style": NamedSet(
        "the 100STYLE dataset by Ian Mason, Sebastian Starke and Taku Komura",
        "CC BY 4.0",
        "free with the authors' names",
        "zenodo.org/records/8127870",
        Archive(
            "https://zenodo.org/records/8127870/files/100STYLE.zip",
            1469,
            "2c3b4017f8e2397ee6904c9b9f43551d8b426d39ddc3558d121fee9e55cb2d58",
        ),
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
"""SHA-256 of the files that were at hand; that of any other is kept when it is fetched."""


def known(name: str) -> NamedSet:
    """Give what is known of a set.

    Raises
    ------
    MocapError : for an unknown set.

    Examples
    --------
    >>> known("100style").terms()
    "These clips come from the 100STYLE dataset ... under CC BY 4.0: free with the authors' names."
    >>> known("amass")
    Traceback (most recent call last):
    mocap.errors.MocapError: No set 'amass' is known; there are: bandai_namco, lafan1, 100style.
    """
    if name not in SETS:
        raise MocapError(f"No set '{shortened(name, 40)}' is known; there are: {', '.join(SETS)}.")
    return SETS[name]
