"""How fast webs and spaces are, as ratios within one run, on a machine that does nothing else meanwhile.

Run them alone, and see the ratios: pytest -m benchmark -n 0 -s tests/benchmarks/test_match_webs.py
"""

import numpy as np
import pytest

from mocap import datasets, resample
from mocap.matching import distance_grid, point_cloud
from mocap.methods.match_webs import blend_of, build_web, search, weights_for
from tests.benchmarks.timing import fastest
from tests.methods.match_webs.spaces_of_walks import gait, space

pytestmark = pytest.mark.benchmark


@pytest.fixture(scope="module")
def clips(real_data):
    return [datasets.cmu(trial.name) for trial in datasets.trials(16)]


def test_a_web_takes_at_most_ten_distance_grids_and_a_step_of_the_search_a_hundredth(clips):
    """The grid is all against all of the same frames, above the diagonal alone, as the web's is."""
    points = np.concatenate([point_cloud(resample(clip, 30)) for clip in clips]).astype(np.float32)
    web = build_web(clips)
    query = slice(120, 260)
    grid, whole, step = fastest(
        lambda: distance_grid(points, points, window=5),
        lambda: build_web(clips),
        lambda: search(web, 14, query, steps=1),
        turns=3,
    )
    print(f"\ngrid {grid:.2f} s, web {whole:.2f} s = {whole / grid:.1f} grids, a step {1000 * step:.1f} ms")
    assert whole <= 10 * grid
    assert step <= whole / 20


def test_half_the_frames_take_a_fourth_of_the_time(clips):
    half, whole = fastest(lambda: build_web(clips[::2]), lambda: build_web(clips), turns=3)
    frames = sum(map(len, clips)) / sum(map(len, clips[::2]))
    print(f"\n{frames:.2f} times the frames take {whole / half:.1f} times as long (square: {frames**2:.1f})")
    assert whole / half <= 1.5 * frames**2


@pytest.mark.parametrize("method", ["convex", "neighbours"])
def test_to_answer_a_wish_takes_at_most_a_twentieth_of_the_blend(method):
    made = space(400)
    rng = np.random.default_rng(0)
    rows = made.weights[-40:]
    wishes = made.values[-40:] + rng.normal(size=(40, 2)) * made.scale / 10
    blend, inverse = fastest(
        lambda: [gait(blend_of(made.examples, row, fps=30)) for row in rows],
        lambda: [weights_for(made, wish, method=method) for wish in wishes],
    )
    share = 100 * inverse / blend
    print(f"\n{method}: a blend {25 * blend:.1f} ms, weights for a wish {share:.1f} % of it")
    assert inverse <= 0.05 * blend
