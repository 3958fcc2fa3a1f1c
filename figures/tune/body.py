"""Trials of the constants of bodies and paths: `python figures/tune/body.py [--quick] [--clips FOLDER ...]`.

- `path_spacing`: circles of 0.5 and 2 m as lines of points. Error: the largest distance of the line's pieces
  from the circle, micrometres; points: their number.
- `hinge`, `still`: knees and elbows of the clips, joints that are hinges in most files, and all other joints.
  Hinges: the percentage of knees and elbows that get an axis; others: that of the other joints. Ratio: the
  largest second singular value of a knee or elbow, over the first. A larger `hinge` takes other joints for
  hinges before it finds more knees; with a larger `still` the axes of the files decide.
"""

import numpy as np
from _trials import BUNDLED_WALKS, CAPTURED_WALKS, Clips, Collection, Row, Study, Trial, cmu

from mocap.body import circle, find_legs, rotations, tuned
from mocap.body.kinematics import hinge_of
from mocap.body.motion import Motion

RADII = (0.5, 2.0)  # metres of circles
ELBOWS = ("radius", "forearm")  # in the names of joints


def circles(clips: Clips) -> Row:
    """Measure circles: the sagitta of their pieces, and their points."""
    errors = []
    points = 0
    for radius in RADII:
        path = circle(radius)
        middles = (path.points[1:] + path.points[:-1]) / 2
        centre = (path.points.min(axis=0) + path.points.max(axis=0)) / 2
        errors.append(radius - np.hypot(*(middles - centre).T).min())
        points += len(path.points)
    return {"error, µm": 1e6 * float(max(errors)), "points": points}


def hinges(clips: Clips) -> Row:
    """Count joints that are hinges, among knees and elbows and among all others."""
    marks: dict[bool, list[bool]] = {True: [], False: []}
    ratios = [0.0]
    for clip in clips:
        expected = expected_hinges(clip)
        for joint in range(1, len(clip.skeleton)):
            is_expected = joint in expected
            marks[is_expected].append(hinge_of(clip, joint) is not None)
            if is_expected:
                ratios.append(spread_ratio(clip, joint))
    percent = {kind: 100 * float(np.mean(of_kind)) for kind, of_kind in marks.items()}
    return {"hinges, %": percent[True], "others, %": percent[False], "ratio": max(ratios)}


def expected_hinges(clip: Motion) -> set[int]:
    """Return the knees, and the joints that are named like elbows."""
    knees = {leg.knee for leg in find_legs(clip.skeleton)}
    names = [name.lower() for name in clip.skeleton.names]
    return knees | {joint for joint, name in enumerate(names) if any(part in name for part in ELBOWS)}


def spread_ratio(clip: Motion, joint: int) -> float:
    """Return the second singular value of a joint's rotation vectors, over the first."""
    quaternions = clip.rotations[:, joint]
    vectors = rotations.difference(rotations.mean(quaternions), quaternions)
    spread = np.linalg.svd(vectors - vectors.mean(axis=0), compute_uv=False)
    return float(spread[1] / max(spread[0], 1e-12))


CMU_02 = Collection("CMU 02, ten clips", cmu("02", *range(1, 11)))
TRIALS = {
    "path_spacing": Trial(circles, (0.1, 0.005, 0.01, 0.05), needs_clips=False),
    "hinge": Trial(hinges, (0.5, 0.005, 0.01, 0.02, 0.1, 0.2)),
    "still": Trial(hinges, (0.1, 0.0, 0.001, 0.05, 0.3)),
}
STUDY = Study(tuned, TRIALS, {}, (BUNDLED_WALKS, CAPTURED_WALKS, CMU_02))

if __name__ == "__main__":
    STUDY.main(__doc__)
