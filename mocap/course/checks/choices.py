"""Checks of notebook 05b."""

from itertools import pairwise
from typing import Any

import numpy as np

from mocap.course.check import Check, Mistake, close

Point = tuple[float, float]


def _clip(rng: np.random.Generator) -> tuple[int, list[int], list[int], int]:
    """Draw a clip's length, where transitions leave and enter it, and their window."""
    frames, window = int(rng.integers(60, 300)), int(rng.integers(5, 15))
    leaves, enters = (rng.integers(0, frames - window, rng.integers(1, 9)) for _ in range(2))
    return frames, [*leaves.tolist(), int(leaves[0])], enters.tolist(), window


def _same_order(given: Any, wanted: Any) -> bool:  # noqa: ANN401
    return bool(given == wanted) if isinstance(given, set) else close(given, wanted)


def _turn(rng: np.random.Generator) -> tuple[float, float, float]:
    """Draw a planar transform: often no turn at all, a very small one, or a half turn."""
    angle = rng.choice([0.0, 1e-3, -1e-3, np.pi, *rng.uniform(-3, 3, 4)])
    return float(angle), *rng.uniform(-2, 2, 2).tolist()


def _fixed_point(angle: float, x: float, z: float) -> Point | None:
    """Solve T c = c, with the point (x, z) as the complex number z + ix."""
    if angle == 0:
        return None
    centre = complex(z, x) / (1 - np.exp(1j * angle))
    return float(centre.imag), float(centre.real)


def _or_nan(angle: float, x: float, z: float) -> Point:
    return _fixed_point(angle, x, z) or (np.nan, np.nan)


def _same_point(given: Any, wanted: Point | None) -> bool:  # noqa: ANN401
    """Compare two points, or two answers that no point stays; a division by zero may give inf or nan."""
    if given is None or wanted is None:
        return given is wanted
    a, b = np.asarray(given, float), np.asarray(wanted, float)
    if a.shape == b.shape and not np.isfinite(b).all():
        return not np.isfinite(a).all()
    return a.shape == b.shape and np.allclose(a, b, rtol=1e-6, atol=1e-9)


turning_point = Check(
    name="turning_point",
    asks="the point (x, z) that the transform leaves where it is, or None where there is none",
    start="write T c = c with the formula of a planar transform: two equations for the two numbers of c.",
    draw=_turn,
    truth=_fixed_point,
    same=_same_point,
    mistakes=[
        Mistake(_or_nan, "without a turn every point is shifted and none stays: give None for angle 0."),
        Mistake(
            lambda angle, x, z: _fixed_point(-angle, x, z),
            "the turn has the wrong sign: x' = x cos θ + z sin θ + x₀.",
        ),
        Mistake(
            lambda angle, x, z: (x / 2, z / 2) if angle else None,
            "half of the shift is right for a half turn only.",
        ),
        Mistake(lambda angle, x, z: (x, z), "that is where the origin goes; which point stays?"),
        Mistake(
            lambda angle, x, z: _fixed_point(angle, -x, -z),
            "the signs are wrong: c - R c = shift, not R c - c.",
        ),
        Mistake(
            lambda angle, x, z: (_fixed_point(angle, x, z) or ())[::-1] or None,
            "the order is (x, z).",
        ),
    ],
)

choice_points = Check(
    name="choice_points",
    asks="the frames of the clip's nodes, in order and each once",
    start="a clip without transitions has two nodes, where it starts and where it ends.",
    draw=_clip,
    truth=lambda frames, leaves, enters, window: sorted({0, frames, *leaves, *(e + window for e in enters)}),
    same=_same_order,
    mistakes=[
        Mistake(
            lambda frames, leaves, enters, window: {0, frames, *leaves, *(e + window for e in enters)},
            "these are the right frames, but a set has no order: sort them.",
        ),
        Mistake(
            lambda frames, leaves, enters, window: sorted({0, frames, *leaves, *enters}),
            "the blend already plays the window: the clip continues *after* the window that is entered.",
        ),
        Mistake(
            lambda frames, leaves, enters, window: sorted({*leaves, *(e + window for e in enters)}),
            "the clip's start and end are nodes too.",
        ),
        Mistake(
            lambda frames, leaves, enters, window: sorted(
                {0, frames, *(i + window for i in leaves), *(e + window for e in enters)}
            ),
            "a transition leaves where its window starts: the blend plays the window's frames.",
        ),
        Mistake(
            lambda frames, leaves, enters, window: sorted(
                {0, frames - 1, *leaves, *(e + window for e in enters)}
            ),
            "node f lies before frame f, so the node after the last frame is `frames`.",
        ),
        Mistake(
            lambda frames, leaves, enters, window: sorted(
                [0, frames, *leaves, *(e + window for e in enters)]
            ),
            "if two transitions meet the clip at the same frame, there is one node, not two.",
        ),
    ],
)


Places = list[tuple[int, int]]
Following = dict[tuple[int, int], Places]
Links = list[tuple[int, int, int, int]]


def _clips(rng: np.random.Generator) -> tuple[list[list[int]], Links, int]:
    """Draw the choice points of two or three clips, the transitions between them, and their window."""
    window, lengths = int(rng.integers(3, 9)), rng.integers(60, 120, rng.integers(2, 4))
    points = [{0, int(length)} for length in lengths]
    links = []
    for _ in range(rng.integers(3, 8)):
        source, target = rng.integers(len(lengths), size=2).tolist()
        leave, enter = (int(rng.integers(1, lengths[clip] - window)) for clip in (source, target))
        points[source].add(leave)
        points[target].add(enter + window)
        links.append((source, leave, target, enter))
    return [sorted(frames) for frames in points], links, window


def _follow(points: list[list[int]], links: Links, window: int) -> Following:
    """Join each choice point to the next of its clip, and the two ends of each transition."""
    following: Following = {(clip, frame): [] for clip, frames in enumerate(points) for frame in frames}
    for clip, frames in enumerate(points):
        for here, there in pairwise(frames):
            following[clip, here].append((clip, there))
    for source, leave, target, enter in links:
        following.setdefault((source, leave), []).append((target, enter + window))
    return following


def _with_chain(points: list[list[int]], links: Links, window: int) -> Following:
    """Join the end of each clip to the start of the next one as well."""
    following = _follow(points, links, window)
    for clip, (here, _) in enumerate(pairwise(points)):
        following[clip, here[-1]].append((clip + 1, 0))
    return following


def _with_all_later(points: list[list[int]], links: Links, window: int) -> Following:
    following = _follow([[]] * len(points), links, window)
    for clip, frames in enumerate(points):
        for here in frames:
            later = [(clip, there) for there in frames if there > here]
            following[clip, here] = [*later, *following.get((clip, here), [])]
    return following


def _same_following(given: Any, wanted: Any) -> bool:  # noqa: ANN401
    """Compare what follows each node, in any order."""
    return {node: sorted(ends) for node, ends in given.items()} == {
        node: sorted(ends) for node, ends in wanted.items()
    }


successors_of = Check(
    name="successors_of",
    asks="a dictionary from each node (clip, frame) to the list of the nodes that its edges lead to",
    start="begin with an empty list for each node; pairwise(points[clip]) gives the stretches of a clip.",
    draw=_clips,
    truth=_follow,
    same=_same_following,
    mistakes=[
        Mistake(
            lambda points, links, window: _follow(
                points, [(s, i, t, j - window) for s, i, t, j in links], window
            ),
            "a transition ends after its window: at the node enter + window, not at enter.",
        ),
        Mistake(
            lambda points, links, window: _follow(
                points, [(s, i + window, t, j) for s, i, t, j in links], window
            ),
            "a transition begins where its window starts: at the node leave, not at leave + window.",
        ),
        Mistake(_with_chain, "no edge leads from the end of a clip to the start of the next clip."),
        Mistake(_with_all_later, "a stretch of clip ends at the next choice point, not at every later one."),
        Mistake(
            lambda points, links, window: _follow(points, [], window),
            "these are the stretches of clip; the transitions are missing.",
        ),
        Mistake(
            lambda points, links, window: {
                node: ends for node, ends in _follow(points, links, window).items() if ends
            },
            "the last node of a clip may lead nowhere, but it is a node: give it an empty list.",
        ),
        Mistake(
            lambda points, links, window: _follow(
                points,
                [*links, *((t, j + window, s, i - window) for s, i, t, j in links)],
                window,
            ),
            "a transition leads one way; the way back has a window of its own, and is in the list.",
        ),
    ],
)
