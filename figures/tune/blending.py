"""Trials of the constants of blends: `python figures/tune/blending.py [--quick] [--clips FOLDER ...]`.

All pairs of clips are registered, 4 s in the middle of each. A clip is of the kind that its label says;
without labels it is a run if its root goes 2 m/s or more, else a walk.

- Curves of time, for pairs of one kind. Strikes: the median of the time from a foot strike of one clip to the
  other clip's, where the registration puts it. Wobble: the standard deviation of the pace over its mean, as
  both go evenly. Distance: the mean RMS distance along the path.
- `shortest_footplant`: plants that are matched, and the foot sliding distance of the even blend.
- `clock_step`: the largest error of the blend's clock, against steps a tenth as long.
- Warnings: the percentage of pairs of one kind that are warned of, and of pairs of two kinds; at best 0 and
  100.
"""

import warnings
from collections.abc import Iterator
from itertools import combinations

import numpy as np
from _trials import RATE, Clips, Collection, Row, Study, Trial, cmu, middle_of, varied

from mocap.blending import Registration, frame_times, mix, register, tuned
from mocap.body import Motion, find_legs
from mocap.errors import MocapError, MocapWarning
from mocap.feet import mark_plants
from mocap.quality import foot_sliding
from mocap.quality.seam_measures import mean_foot_sliding

SECONDS = 4.0  # of each clip
RUN = 2.0  # m/s
REFERENCE_STEP = 0.0002  # seconds


def pairs(clips: Clips, *, same_kind: bool = True) -> Iterator[tuple[Motion, Motion]]:
    """Yield pairs of clips of one kind, or of two."""
    cut = [mark_plants(middle_of(clip, SECONDS)) for clip in clips]
    for first, second in combinations(cut, 2):
        if (kind_of(first) == kind_of(second)) == same_kind:
            yield first, second


def kind_of(clip: Motion) -> str:
    """Return the label of most of a clip's frames, or what its speed says."""
    if clip.labels:
        return max(clip.labels, key=lambda label: clip.labels[label].mean())
    steps = np.linalg.norm(np.diff(clip.root_positions[:, [0, 2]], axis=0), axis=1)
    return "run" if steps.mean() * clip.fps >= RUN else "walk"


def curves(clips: Clips) -> Row:
    """Measure the curves of time."""
    registered = [register(pair) for pair in pairs(clips)]
    errors = np.concatenate([strike_errors(pair) for pair in registered])
    wobbles = [wobble(pair) for pair in registered]
    row = {"strikes, ms": 1000 * float(np.median(errors)), "wobble, %": 100 * float(np.mean(wobbles))}
    return row | {"distance, cm": 100 * float(np.mean([pair.costs.max() for pair in registered]))}


def strike_errors(pair: Registration) -> np.ndarray:
    """Return the seconds from each strike of the first clip to the nearest one of the second."""
    first, second = pair.clips
    errors = [np.empty(0)]
    for joint in first.contacts:
        later = strikes(second, joint)
        moments = pair.times[1](strikes(first, joint))
        if len(later) and len(moments):
            errors.append(np.abs(moments[:, None] - later).min(axis=1))
    return np.concatenate(errors)


def strikes(clip: Motion, joint: str) -> np.ndarray:
    """Return the seconds at which a joint comes to stand."""
    stands = clip.contacts[joint]
    return (np.flatnonzero(stands[1:] & ~stands[:-1]) + 1) / clip.fps


def wobble(pair: Registration) -> float:
    """Return the standard deviation of the second clip's pace, over its mean."""
    steps = np.diff(pair.times[1](np.linspace(*pair.span, 100)))
    return float(steps.std() / steps.mean())


def plants(clips: Clips) -> Row:
    """Count matched plants, and measure the foot sliding of blends."""
    count = 0
    slides = []
    for pair in pairs(clips):
        registered = register(pair)
        count += len(registered.contacts)
        blend = mix(registered, [0.5, 0.5])
        feet = [joint for leg in find_legs(blend.skeleton) for joint in (leg.ankle, leg.ball)]
        slides.append(mean_foot_sliding(foot_sliding(blend, feet)))
    return {"plants": count, "slide, cm": float(np.mean(slides))}


def clock(clips: Clips) -> Row:
    """Compare clocks with those of short steps."""
    errors = []
    for pair in pairs(clips):
        registered = register(pair)
        times, _ = frame_times(registered, [0.5, 0.5], fps=RATE)
        with varied(tuned, clock_step=REFERENCE_STEP):
            exact, _ = frame_times(registered, [0.5, 0.5], fps=RATE)
        count = min(len(times), len(exact))
        errors.append(np.abs(times[:count] - exact[:count]).max())
    return {"error, µs": 1e6 * float(max(errors))}


def warned(clips: Clips) -> Row:
    """Count pairs that are warned of, or refused."""
    alike = [is_warned(pair) for pair in pairs(clips)]
    different = [is_warned(pair) for pair in pairs(clips, same_kind=False)]
    row = {"one kind, %": 100 * float(np.mean(alike))}
    return row | ({"two kinds, %": 100 * float(np.mean(different))} if different else {})


def is_warned(pair: tuple[Motion, Motion]) -> bool:
    """Tell whether the registration of a pair warns, or is refused."""
    with warnings.catch_warnings(record=True, action="always", category=MocapWarning) as caught:
        try:
            register(pair)
        except MocapError:
            return True
    return bool(caught)


BUNDLED_NAMES = ("walk_5m_0.8_0", "walk_5m_1.1_0", "walk_5m_1.4_0", "walk_5m_1.1_120", "jog", "sneak")
BUNDLED = Collection("four walks, a jog and a sneak", BUNDLED_NAMES)
CMU_NAMES = cmu("16", 15, 21, 22, 31, 47, 17, 19, 35, 36, 37, 45, 46)
CMU = Collection("CMU 16, seven walks and five runs", CMU_NAMES)

# reads: statement: a table
TRIALS = {
    "rate": Trial(curves, (10.0, 15.0)),
    "window": Trial(curves, (15, 1, 3, 9)),
    "spacing": Trial(curves, (0.1, 0.2, 0.5, 1.0)),
    "wider_spacings": Trial(curves, ((), (np.inf,), (8.0, 4.0, 2.0), (4.0, 2.0))),
    "as_good": Trial(curves, (1.0, 1.02, 1.15, 1.3)),
    "shortest_footplant": Trial(plants, (0.1, 0.0, 0.05)),
    "clock_step": Trial(clock, (0.02, 0.001, 0.005, 0.01)),
    "unlike": Trial(warned, (0.05, 0.08, 0.16, 0.24)),
    "unlike_time": Trial(warned, (0.02, 0.04, 0.09, 0.12)),
    "sliding_ratio": Trial(warned, (1.0, 1.2, 2.0, 3.0)),
    "sliding_difference": Trial(warned, (0.0, 0.005, 0.03, 0.1)),
}
EXCUSES = {
    "band": "the clips here are shorter than the band; tests compare longer ones with whole grids",
    "band_margin": "as `band`: the clips here never reach its edge",
    "many_knots": "only the time depends on it, and curves of more than a minute have so many knots",
}
STUDY = Study(tuned, TRIALS, EXCUSES, (BUNDLED, CMU))

if __name__ == "__main__":
    STUDY.main(__doc__)
