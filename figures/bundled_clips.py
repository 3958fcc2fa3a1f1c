"""Make the bundled clips: `python figures/bundled_clips.py` writes `mocap/datasets/clips.npz`.

The clips are smooth. So the differences of the differences ... of their numbers, six times, are small, and
fit into few bits once all numbers are rounded to multiples of 2⁻³¹: half a nanometre.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from walking.generated import CLIPS, generate, generate_walk
from walking.jumping import generate_jump
from walking.walking_body import SKELETON

from mocap.body.ground_path import arcs
from mocap.body.motion import Motion
from mocap.datasets import samples

BYTES = 8  # of a number
BEND = [[0, 0], [0, 2], [-1.2, 3.6], [-3, 4]]  # points on the ground, metres
WALKS = {
    "walk_5m": (5, (0.8, 1.1, 1.4), (-120, 0, 120), 20),
    "walk_6m": (6, (0.7, 0.9, 1.15, 1.4, 1.65), (-180, 0, 180), 1),
}  # metres, metres per second, degrees; every how many points of the arc the path passes through


def bundled_clips() -> Iterator[tuple[str, Motion]]:
    """Make all clips that the package brings, with the names by which `datasets.sample` gives them."""
    for name in CLIPS:
        yield name, generate(name)
    yield "jump", generate_jump()
    yield "bend_sneak", generate_walk(BEND, style="sneak", seed=1)
    yield "bend_walk", generate_walk(BEND, style="walk", speed=1.3)
    for kind, (metres, speeds, turns, spacing) in WALKS.items():
        for seed, (speed, turn) in enumerate(product(speeds, turns)):
            path = arcs((0.0, 0.0), 0.0, [(metres, np.radians(turn))]).points[::spacing]
            yield f"{kind}_{speed}_{turn}", generate_walk(path, speed=speed, seed=seed)


def pack(motion: Motion) -> dict[str, Any]:
    """Pack a motion as `sample` reads it, without the real parts of the quaternions below the root.

    `flipped` marks where these are negative. The numbers are shown as bytes, the lowest first: those of a
    kind are alike, and compress well.
    """
    flipped = motion.rotations[..., 0] < 0
    flipped[:, 0] = False
    turns = np.where(flipped[..., None], -motion.rotations, motion.rotations)
    columns = [motion.root_positions, turns[:, 0], turns[:, 1:, 1:].reshape(len(motion), -1)]
    whole = np.rint(np.concatenate(columns, axis=1).T / samples.UNIT).astype(np.int64)
    moving = whole.any(axis=1)
    steps = np.diff(whole[moving], samples.ORDER, prepend=np.zeros((moving.sum(), samples.ORDER), int))
    folded = np.ascontiguousarray((steps << 1) ^ (steps >> 63))  # 0, -1, 1, -2, ... become 0, 1, 2, 3, ...
    digits = np.moveaxis(folded.view(np.uint8).reshape(*folded.shape, BYTES), -1, 0)
    last = np.flatnonzero(digits.any(axis=(1, 2)))[-1]
    assert (np.sum(list(motion.labels.values()), axis=0) == 1).all(), "one label for each frame"
    kind = np.argmax(list(motion.labels.values()), axis=0).astype(np.uint8)
    marks = {"labels": list(motion.labels), "kind": kind, "contacts": list(motion.contacts.values())}
    return {"digits": digits[: last + 1], "moving": moving, "flipped": flipped.T, **marks}


def save(path: Path) -> None:
    """Write all clips, and the skeleton that they share."""
    arrays = {"names": SKELETON.names, "parents": SKELETON.parents, "offsets": SKELETON.offsets}
    for name, motion in bundled_clips():
        assert list(motion.contacts) == samples.FEET
        arrays |= {f"{name}/{key}": array for key, array in pack(motion).items()}
    np.savez_compressed(path, **arrays)


if __name__ == "__main__":
    save(samples.STORE)
