"""The unit and the vertical axis of clips of many sources, found from their frames.

    python figures/clip_spaces.py

Each source is a set of clips in metres with y up: captured ones of a folder that `MOCAP_DATA` names, which
are skipped if it is not there, and bundled ones at other sizes. Each set is written in seven units, with y
and with z up, and decided as a set, of which the worst clip counts. The table counts the spaces that are
right, without or with a doubt, and those that are wrong, stated or in silence. A small body at an adult's
pace has the same numbers as an adult in another unit.
"""

import os
import warnings
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

import mocap
from mocap.body import Motion, joint_positions, rotations
from mocap.datasets import sample
from mocap.files.clip_sets import SetMember, agreed_spaces
from mocap.files.space_evidence import frames_to_look_at, gather
from mocap.files.spaces import UNITS, UPRIGHT, Space, decide

CAPTURED = {
    "Bandai-Namco": ("../bvh/bandai_namco/*.bvh", 0.01),
    "Mixamo": ("../bvh/20tab/test_freebvh.bvh", 0.01),
    "Mocapbank": ("../bvh/20tab/test_mocapbank.bvh", 0.01),
    "CMU as BVH": ("../bvh/imusim/*.bvh", 0.01),
    "BVH toolbox": ("../bvh/olaf_bvh_toolbox/*.bvh", 0.01),
    "puppy0512": ("../bvh/puppy0512_motion_graph/*.bvh", 0.01),
    "Meredith": ("../bvh/pymo/*.bvh", 0.0254),
    "CMU 02": ("02/02_0[1-9].amc", None),
    "CMU 16": ("16/16_1*.amc", None),
    "CMU 49": ("49/49_0*.amc", None),
}
OUTCOMES = ("right", "right, in doubt", "wrong, stated", "WRONG IN SILENCE")
FORMAT = (0.01, "y")  # the unit and the axis by default
NAMES = {"scale": "scale=", "up": "up="}


def captured() -> Iterator[tuple[str, list[Motion]]]:
    """Yield the sets of captured clips that are there."""
    folder = Path(os.environ.get("MOCAP_DATA", "."))
    for name, (pattern, scale) in CAPTURED.items():
        paths = sorted(folder.glob(pattern))
        if paths:
            yield name, [mocap.load(path, scale=scale, up="y" if scale else None) for path in paths]
        else:
            print(f"{name}: not in {folder}.")


def generated() -> Iterator[tuple[str, list[Motion]]]:
    """Yield sets that are made of bundled clips."""
    clips = [sample(name) for name in mocap.datasets.SAMPLES]
    for clip in clips:
        yield clip.name, [clip]
    yield "all bundled clips", clips
    for metres in (1.5, 1.9):
        yield f"adult of {metres} m", [resized(clip, metres) for clip in clips]
    for metres in (1.0, 0.75, 0.3):
        yield f"body of {metres} m, own pace", [resized(clip, metres, own_pace=True) for clip in clips]
    yield "body of 0.3 m, adult's pace", [resized(clip, 0.3) for clip in clips]
    yield "one frame", [clips[0][:1]]
    yield "lying", [lying(clips[0])]


def resized(clip: Motion, metres: float, *, own_pace: bool = False) -> Motion:
    """Return a clip of a body of another height, of which a small one moves faster at its own pace."""
    size = metres / 1.75
    fps = clip.fps / np.sqrt(size) if own_pace else clip.fps
    skeleton = replace(clip.skeleton, offsets=size * clip.skeleton.offsets)
    return replace(clip, skeleton=skeleton, root_positions=size * clip.root_positions, fps=fps)


def lying(clip: Motion) -> Motion:
    """Return a clip whose body lies on its back."""
    backwards = rotations.multiply(rotations.from_rotvec([np.pi / 2, 0, 0]), clip.rotations[:, :1])
    turned = np.concatenate([backwards, clip.rotations[:, 1:]], axis=1)
    return replace(clip, rotations=turned, root_positions=np.full((len(clip), 3), [0.0, 0.2, 0.0]))


def members_in(clips: Sequence[Motion], unit: float, up: str) -> list[SetMember]:
    """Gather the evidence of clips that are written in a unit, with an axis up."""
    members = []
    for clip in clips:
        frames, rate = frames_to_look_at(clip.root_positions, clip.fps)
        positions = joint_positions(clip)[frames] / unit
        turned = rotations.rotate(rotations.inverse(UPRIGHT[up]), positions)
        skeleton = clip.skeleton
        evidence = gather(skeleton.parents, turned, rate)
        if evidence is not None:
            hierarchy = (tuple(skeleton.names), tuple(skeleton.parents.tolist()))
            bones = float(np.linalg.norm(skeleton.offsets[1:], axis=-1).sum()) / unit
            members.append(
                SetMember(hierarchy, bones, decide([evidence], FORMAT, scale=None, up=None), evidence)
            )
    return members


def outcomes(clips: Sequence[Motion]) -> Counter[str]:
    """Count the outcomes of a set over units and axes."""
    spaces = [(unit, up) for unit in UNITS for up in ("y", "z")]
    return Counter(outcome(clips, unit, up) for unit, up in spaces)


def outcome(clips: Sequence[Motion], unit: float, up: str) -> str:
    """Decide the spaces of the clips of a set, and name the worst outcome."""
    spaces = agreed_spaces(members_in(clips, unit, up))
    return max((outcome_of(space, unit, up) for space in spaces if space), key=OUTCOMES.index)


def outcome_of(space: Space, unit: float, up: str) -> str:
    """Name the outcome of a clip."""
    if (space.scale, space.up) == (unit, up):
        return "right, in doubt" if space.doubt else "right"
    return "wrong, stated" if space.sentence(NAMES) else "WRONG IN SILENCE"


def main() -> None:
    """Print the table."""
    warnings.simplefilter("ignore", mocap.MocapWarning)
    print(f"{'':<32}", *(f"{title:>18}" for title in OUTCOMES))
    for source in (captured, generated):
        for name, clips in source():
            counts = outcomes(clips)
            print(f"{name + f' ({len(clips)})':<32}", *(f"{counts[title]:>18}" for title in OUTCOMES))


if __name__ == "__main__":
    main()
