"""Captured turns by 45°, 90° and 180°, to both sides: found from one, and asked for by their angle."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from mocap import load
from mocap._shared.arrays import runs
from mocap.blending.registering import register
from mocap.body.planar import heading
from mocap.methods.match_webs import (
    MotionSpace,
    blend_of,
    build_web,
    cut_out,
    sample_space,
    search,
    turn,
    weights_for,
)
from tests.methods.match_webs.conftest import judge

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


@pytest.mark.exhaustive
@pytest.mark.parametrize(
    ("angle", "recall", "precision"),
    [(45, 0.8, 0.3), (-45, 0.9, 0.35), (90, 0.6, 0.5), (-90, 0.35, 0.7), (180, 0.2, 0.8)],
)
def test_one_turn_finds_others_of_its_angle(walker, web, angle, recall, precision):
    """In one step below 8 cm, of what turns as far as the query, to 20° or a fifth."""
    _, turns = walker
    truth, hits, wrong = turns[angle], 0, 0
    for query in truth[:4]:
        found = search(web, *query, below=0.08, steps=1)
        own = degrees(cut_out(web, found[0]))
        kept = [match for match in found if abs(degrees(cut_out(web, match)) - own) <= max(20, abs(own) / 5)]
        right, other = judge(kept, truth)
        hits, wrong = hits + right - 1, wrong + other
    possible = len(truth[:4]) * (len(truth) - 1)
    print(f"{angle}°: recall {hits / possible:.2f}, precision {hits / max(hits + wrong, 1):.2f}")
    assert hits / possible >= recall and hits / (hits + wrong) >= precision


@pytest.fixture(scope="module")
def web(walker):
    return build_web(walker[0], below=0.08)
