"""Fingerprints of clips: hashes that identify a clip under any name."""

import hashlib

import numpy as np

from mocap.body.motion import Motion


def fingerprint(motion: Motion) -> str:
    """Compute a hash (SHA-256) of a clip's skeleton, poses, rate and labels, which determine its graph.

    Numbers are rounded to six decimals, because the last digits depend on the machine.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from mocap.body.skeleton import Skeleton
    >>> bone = Skeleton(["root"], [-1], [[0, 0, 0]])
    >>> still = Motion(bone, np.zeros((4, 3)), np.tile([1.0, 0, 0, 0], (4, 1, 1)), 30.0, "still")
    >>> renamed = replace(still, name="other")
    >>> slower = replace(still, fps=15.0)
    >>> fingerprint(renamed) == fingerprint(still), fingerprint(slower) == fingerprint(still)
    (True, False)
    """
    skeleton = motion.skeleton
    digest = hashlib.sha256(repr((skeleton.names, motion.fps, sorted(motion.labels))).encode())
    marks = [motion.labels[label] for label in sorted(motion.labels)]
    for array in (skeleton.parents, skeleton.offsets, motion.root_positions, motion.rotations, *marks):
        rounded = np.round(np.array(array, "<f8", order="C"), 6) + 0.0  # not -0.0
        digest.update(f"{array.shape}".encode() + rounded.tobytes())
    return digest.hexdigest()
