"""Captured turns by 45°, 90° and 180°, to both sides: found from one, and asked for by their angle."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from mocap import load
from mocap._shared.arrays import runs
from mocap.blending.registering import register
from mocap.body.planar import heading
from mocap.methods.match_webs import blend_of, sample_space, turn, weights_for
from mocap.methods.match_webs.motion_spaces import MotionSpace

ANGLES = (45, 90, 180, -45, -90, -180)
AROUND = 10  # frames at 30 Hz before and after the body turns by more than 25° per second


def degrees(motion):
    return np.degrees(turn(motion))


@pytest.fixture(scope="module")
def walker(real_data):
    """The six clips, and the turns in them by the angle to which they are nearest: (clip, frames)."""
    folder = real_data / "bvh" / "puppy0512_motion_graph"
    clips = [load(path) for path in sorted(folder.glob("*.bvh"))]
    turns = {angle: [] for angle in (*ANGLES, 0)}
    for number, clip in enumerate(clips):
        angle = gaussian_filter1d(np.degrees(np.unwrap(heading(clip.rotations[:, 0]))), 8)
        for a, b in runs(np.abs(np.gradient(angle)) * 30 > 25).tolist():
            turned = angle[b - 1] - angle[a]
            inside = a >= AROUND and b + AROUND < len(clip) and b - a > 8 and abs(turned) > 20
            kind = min(ANGLES, key=lambda each: abs(each - 1.07 * turned))
            if inside and abs(kind - 1.07 * turned) < 25:
                turns[kind].append((number, slice(a - AROUND, b + AROUND)))
    return clips, turns


@pytest.mark.parametrize(
    ("side", "count"),
    [(1, 20), *(pytest.param(*case, marks=pytest.mark.sweep) for case in ((-1, 18), (0, 40)))],
)
def test_turns_are_got_as_asked_without_the_one_that_is_asked_for(walker, side, count):
    clips, turns = walker
    cuts = [clips[n][part] for angle in ANGLES if angle * side >= 0 for n, part in turns[angle]]
    assert len(cuts) >= count
    middle = int(np.argsort([len(cut) for cut in cuts])[len(cuts) // 2])
    with pytest.warns(match="may not be the same kind of motion"):
        registered = register(cuts, slack=0, reference=middle)
    made = sample_space(registered, degrees, count=100)
    off = []
    for out, asked in enumerate(made.values[: len(cuts)]):
        others = np.abs(made.weights[:, out]) < 1e-12
        known = MotionSpace(registered, made.weights[others], made.values[others], made.scale)
        off.append(degrees(blend_of(registered, weights_for(known, asked))) - float(asked[0]))
    assert np.abs(off).mean() <= 2
