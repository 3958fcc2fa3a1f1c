"""Trials of the constants of in-betweening: `python figures/tune/in_betweening.py [--quick]`.

Motions from a pose of a clip to a later one, which is turned by 6° and moved by up to 28 cm, through
the graph of two other clips. Refused: how many requests have no motion, or meet the poses with sliding feet.
Turned: the largest rate of turning that was added; 60° per second is the limit. Steps: the largest change of
the length of a step, percent. Price: the mean cost of these changes. Peak: the largest acceleration of the
body's points, over that of the clips.
"""

from functools import cache

import numpy as np
from _trials import CAPTURED_WALKS, WALKS, Clips, Collection, Row, Study, Trial
from _walks import compiled

from mocap.body import Motion
from mocap.body.planar import PlanarTransform
from mocap.errors import NoWalk
from mocap.methods.in_betweening import in_between, tuned
from mocap.quality import jumps

TURN = 0.1  # radians, to the left
REQUESTS = ((0.2, 2.2, 0.0), (0.6, 2.5, 0.2))  # where in the clip, seconds, and metres of the shift


@cache
def requests(clips: Clips) -> list[tuple[Motion, Motion, float]]:
    """Return poses from the longest of the other clips, and the seconds from one to the other."""
    clip = max(clips[2:], key=len)
    wanted = []
    for part, seconds, shift in REQUESTS:
        frames = round(seconds * clip.fps)
        first = int(part * (len(clip) - frames - 1))
        end = moved(clip[first + frames : first + frames + 1], PlanarTransform(TURN, shift, -shift))
        wanted.append((clip[first : first + 1], end, seconds))
    return wanted


def moved(pose: Motion, transform: PlanarTransform) -> Motion:
    """Turn a pose about its root, and move it."""
    x, _, z = pose.root_positions[0]
    back = PlanarTransform(0.0, -x, -z).apply_motion(pose)
    return PlanarTransform(transform.angle, x + transform.x, z + transform.z).apply_motion(back)


def filled(clips: Clips) -> Row:
    """Make all motions that are asked for."""
    graph = compiled(clips[:2])
    motions = []
    for start, end, seconds in requests(clips):
        try:
            motions.append(in_between(graph, start, end, seconds))
        except NoWalk:
            continue
    row: dict[str, object] = {"refused": len(REQUESTS) - len(motions)}
    if not motions:
        return row
    usual = np.percentile(np.concatenate([jumps(clip) for clip in clips[:2]]), 99)
    peaks = [jumps(filling.motion).max() / usual for filling in motions]
    steps = [np.abs(np.log(filling.arrived.steps)).max() for filling in motions]
    turned = [np.abs(filling.arrived.turned).max() for filling in motions]
    row |= {"turned, °/s": float(np.degrees(max(turned))), "steps, %": 100 * float(np.expm1(max(steps)))}
    prices = [filling.arrived.price for filling in motions]
    return row | {"price": float(np.mean(prices)), "peak": float(max(peaks))}


BUNDLED = Collection("three bundled walks", WALKS[:3])

# reads: statement: a table
TRIALS = {
    "tried": Trial(filled, (4, 12, 48)),
    "most_tried": Trial(filled, (24, 200)),
    "pose": Trial(filled, (0.03, 0.05, 0.2)),
    "rounds": Trial(filled, (1, 2)),
    "fade": Trial(filled, (0.1, 0.25, 1.0)),
    "near_end": Trial(filled, (0.0, 0.15, 0.6)),
    "ahead": Trial(filled, (1 / 30, 0.2)),
    "candidates": Trial(filled, (2, 4, 12)),
    "seam": Trial(filled, (0.0, 0.2, 2.0)),
    "match": Trial(filled, (0.0, 100.0, 1000.0)),
    "end_pose": Trial(filled, (0.0, 30.0, 300.0)),
    "beyond_limit": Trial(filled, (0.0, 10.0, 1000.0)),
    "layer": Trial(filled, (0.3, 0.05, 0.2)),
    "beam": Trial(filled, (50, 100, 1600)),
    "cell": Trial(filled, (0.4, 0.05, 0.2)),
    "angle": Trial(filled, (0.6, 0.07, 0.3)),
    "meeting": Trial(filled, (300, 1000, 10_000)),
    "pairs": Trial(filled, (30_000, 300_000, 10_000_000)),
    "most_rotation": Trial(filled, (np.radians(30), np.radians(45), np.radians(90))),
    "most_steps": Trial(filled, (1.1, 1.5)),
    "most_pace": Trial(filled, (1.1, 1.5)),
    "rotation": Trial(filled, (5.0, 0.05)),
    "stretch": Trial(filled, (0.8, 2.5, 80.0)),
    "within": Trial(filled, (1.0, 0.9)),
    "solver_rounds": Trial(filled, (5, 15, 60)),
    "knots": Trial(filled, (0.6, 0.15)),
    "fewest_spans": Trial(filled, (5, 20)),
    "most_spans": Trial(filled, (10, 80)),
    "per_span": Trial(filled, (1, 2, 8)),
    "rise": Trial(filled, (0.05, 0.3)),
}
STUDY = Study(tuned, TRIALS, {}, (BUNDLED, CAPTURED_WALKS))

if __name__ == "__main__":
    STUDY.main(__doc__)
