"""What a clip is known by, whatever it is called."""

import hashlib

import numpy as np

from mocap.body.motion import Motion


def fingerprint(motion: Motion) -> str:
    """Hash what a saved graph or web needs of a clip: skeleton, poses, rate and labels (SHA-256).

    Examples
    --------
    >>> from dataclasses import replace
    >>> from mocap.body.skeleton import Skeleton
    >>> bone = Skeleton(["root"], [-1], [[0, 0, 0]])
    >>> still = Motion(bone, np.zeros((4, 3)), np.tile([1.0, 0, 0, 0], (4, 1, 1)), 30.0, "still")
    >>> fingerprint(still) == fingerprint(replace(still, name="other"))
    True
    """
    skeleton = motion.skeleton
    digest = hashlib.sha256(repr((skeleton.names, motion.fps, sorted(motion.labels))).encode())
    marks = [motion.labels[label] for label in sorted(motion.labels)]
    for array in (skeleton.parents, skeleton.offsets, motion.root_positions, motion.rotations, *marks):
        digest.update(f"{array.dtype.str}{array.shape}".encode())
        digest.update(np.ascontiguousarray(array).data)
    return digest.hexdigest()
