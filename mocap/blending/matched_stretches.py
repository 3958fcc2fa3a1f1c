"""Many pairs of clips to blend: stretches around matches, drawn at random."""

from collections.abc import Sequence

import numpy as np

from mocap.body.motion import Motion
from mocap.errors import MocapError
from mocap.matching.transitions import find_transitions


def draw_stretches(
    clips: Sequence[Motion], count: int, *, window: int, below: float, reach: int
) -> list[tuple[Motion, Motion]]:
    """Draw pairs of stretches whose middles match, the second aligned with the first.

    What one pair shows may be an accident. A claim about blends needs many pairs, drawn by chance.

    Parameters
    ----------
    clips : motions of one skeleton and one frame rate; a pair comes from two of them.
    count : how many pairs.
    window, below : of the matches, as for `matching.find_transitions`.
    reach : frames before and after the middle of the matched window.

    Returns
    -------
    `count` different pairs, the same ones in each call: motions of 2 · reach frames each.

    Raises
    ------
    MocapError : where there are fewer matches with so many frames around them.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> clips = [sample(name)[:480] for name in ("walk_curve_1", "walk_curve_2")]
    >>> pairs = draw_stretches(clips, 3, window=40, below=0.05, reach=60)
    >>> [(len(a), len(b)) for a, b in pairs]
    [(120, 120), (120, 120), (120, 120)]

    Notebook: 04b-feet
    """
    found = find_transitions(clips, window=window, below=below)
    lengths, half = np.array([len(clip) for clip in clips]), window // 2
    before = np.minimum(found.leave, found.enter) + half
    after = np.minimum(lengths[found.source] - found.leave, lengths[found.target] - found.enter) - half
    fit = np.flatnonzero((found.source != found.target) & (before >= reach) & (after >= reach))
    if len(fit) < count:
        have = f"{len(fit)} matches have {reach} frames before and after their middles"
        raise MocapError(f"{have}; {count} were asked for.")
    drawn = np.random.default_rng(0).choice(fit, count, replace=False)
    pairs = []
    for source, leave, target, enter, _, transform in (found[int(n)] for n in drawn):
        low, high = half - reach, half + reach
        a, b = (clips[c][at + low : at + high] for c, at in ((source, leave), (target, enter)))
        pairs.append((a, transform.apply_motion(b)))
    return pairs
