"""Notebook 05: inputs, right answers and mistakes of `choice_points` and `successors_of`."""

from itertools import combinations, pairwise
from typing import Any

import numpy as np

from mocap.course.checks.answers.common import Arguments
from mocap.course.comparisons import close

Node = tuple[int, int]
"""A clip and a frame."""

Link = tuple[int, int, int, int]
"""A transition: the clip and the frame that it leaves, the clip and the frame that it enters."""

# ---- choice_points


def draw_choice_points(rng: np.random.Generator) -> Arguments:
    """Draw a clip's length, where transitions leave and enter it, and their window."""
    frames = int(rng.integers(60, 300))
    window = int(rng.integers(5, 15))
    leaves, enters = (rng.integers(0, frames - window, rng.integers(1, 9)) for _ in range(2))
    return frames, [*leaves.tolist(), int(leaves[0])], enters.tolist(), window


def right_choice_points(frames: int, leaves: list[int], enters: list[int], window: int) -> list[int]:
    """Return the ends of the clip, and the frames at which edges leave it and enter it."""
    return sorted({0, frames, *leaves, *(e + window for e in enters)})


def same_choice_points(answer: Any, wanted: list[int]) -> bool:  # noqa: ANN401
    """Check whether two lists of frames are the same; a set has no order, so it must equal."""
    return answer == wanted if set in (type(answer), type(wanted)) else close(answer, wanted)


def mistake_unsorted(frames: int, leaves: list[int], enters: list[int], window: int) -> object:
    """Return the frames as a set, which has no order."""
    return {0, frames, *leaves, *(e + window for e in enters)}


def mistake_window_played_twice(frames: int, leaves: list[int], enters: list[int], window: int) -> object:
    """Return the ends of the clip, the frames left and the frames entered, without the window."""
    return sorted({0, frames, *leaves, *enters})


def mistake_without_ends(frames: int, leaves: list[int], enters: list[int], window: int) -> object:
    """Return the frames left and the frames entered plus the window, without the ends of the clip."""
    return sorted({*leaves, *(e + window for e in enters)})


def mistake_leaves_after_window(frames: int, leaves: list[int], enters: list[int], window: int) -> object:
    """Return the ends of the clip, and the frames left and the frames entered, both plus the window."""
    return sorted({0, frames, *(i + window for i in leaves), *(e + window for e in enters)})


def mistake_last_frame(frames: int, leaves: list[int], enters: list[int], window: int) -> object:
    """Return the choice points with the last frame, `frames` - 1, as the end of the clip."""
    return sorted({0, frames - 1, *leaves, *(e + window for e in enters)})


def mistake_twice_the_same(frames: int, leaves: list[int], enters: list[int], window: int) -> object:
    """Return the choice points in order, with one entry for each transition, also at the same frame."""
    return sorted([0, frames, *leaves, *(e + window for e in enters)])


def mistake_frame_early(frames: int, leaves: list[int], enters: list[int], window: int) -> object:
    """Return the choice points with the frames entered at e + window - 1."""
    return sorted({0, frames, *leaves, *(e + window - 1 for e in enters)})


def mistake_frame_late(frames: int, leaves: list[int], enters: list[int], window: int) -> object:
    """Return the choice points with the frames entered at e + window + 1."""
    return sorted({0, frames, *leaves, *(e + window + 1 for e in enters)})


def mistake_window_at_leaves(frames: int, leaves: list[int], enters: list[int], window: int) -> object:
    """Return the ends of the clip, the frames left plus the window, and the frames entered without it."""
    return sorted({0, frames, *(i + window for i in leaves), *enters})


def mistake_enters_missing(frames: int, leaves: list[int], enters: list[int], window: int) -> object:
    """Return the ends of the clip and the frames left."""
    return sorted({0, frames, *leaves})


def mistake_leaves_missing(frames: int, leaves: list[int], enters: list[int], window: int) -> object:
    """Return the ends of the clip and the frames entered plus the window."""
    return sorted({0, frames, *(e + window for e in enters)})


def mistake_plain_list(frames: int, leaves: list[int], enters: list[int], window: int) -> object:
    """Return the choice points as listed: the start, frames left, frames entered plus the window, the end."""
    return [0, *leaves, *(e + window for e in enters), frames]


# ---- successors_of


def nodes_of(points: list[list[int]]) -> dict[Node, list[Node]]:
    """Return an empty list for each node."""
    return {(clip, frame): [] for clip, frames in enumerate(points) for frame in frames}


def draw_successors_of(rng: np.random.Generator) -> Arguments:
    """Draw the choice points of two or three clips, the transitions between them, and their window."""
    window = int(rng.integers(3, 9))
    lengths = rng.integers(60, 120, rng.integers(2, 4))
    points = [{0, int(length)} for length in lengths]
    links = []
    for _ in range(rng.integers(3, 8)):
        source, target = rng.integers(len(lengths), size=2).tolist()
        leave, enter = (int(rng.integers(1, lengths[clip] - window)) for clip in (source, target))
        points[source].add(leave)
        points[target].add(enter + window)
        links.append((source, leave, target, enter))
    return [sorted(frames) for frames in points], links, window


def right_successors_of(points: list[list[int]], links: list[Link], window: int) -> dict[Node, list[Node]]:
    """Join each choice point to the next of its clip, and the two ends of each transition."""
    following = nodes_of(points)
    for clip, frames in enumerate(points):
        for start, end in pairwise(frames):
            following[clip, start].append((clip, end))
    for source, leave, target, enter in links:
        following.setdefault((source, leave), []).append((target, enter + window))
    return following


def same_successors_of(answer: Any, wanted: dict[Node, list[Node]]) -> bool:  # noqa: ANN401
    """Check whether the same edges leave the same nodes, in any order."""
    is_same = [sorted(answer[node]) == sorted(ends) for node, ends in wanted.items()]
    return answer.keys() == wanted.keys() and all(is_same)


def mistake_ends_at_enter(points: list[list[int]], links: list[Link], window: int) -> object:
    """Join each transition to (target, enter), where its window starts."""
    early = [(source, leave, target, enter - window) for source, leave, target, enter in links]
    return right_successors_of(points, early, window)


def mistake_begins_after_window(points: list[list[int]], links: list[Link], window: int) -> object:
    """Join each transition from (source, leave + window), where its window ends."""
    late = [(source, leave + window, target, enter) for source, leave, target, enter in links]
    return right_successors_of(points, late, window)


def mistake_clips_joined(points: list[list[int]], links: list[Link], window: int) -> object:
    """Add an edge from the end of each clip to the start of the next clip."""
    lasts = [frames[-1] for frames in points[:-1]]
    joined = [(clip, last, clip + 1, -window) for clip, last in enumerate(lasts)]
    return right_successors_of(points, [*links, *joined], window)


def mistake_skips_choice_points(points: list[list[int]], links: list[Link], window: int) -> object:
    """Join each choice point to every later one of its clip, in addition to the transitions."""
    following = nodes_of(points)
    for clip, frames in enumerate(points):
        for start, end in combinations(frames, 2):
            following[clip, start].append((clip, end))
    for source, leave, target, enter in links:
        following.setdefault((source, leave), []).append((target, enter + window))
    return following


def mistake_without_transitions(points: list[list[int]], links: list[Link], window: int) -> object:
    """Join the choice points of each clip, and leave out the transitions."""
    return right_successors_of(points, [], window)


def mistake_without_last_nodes(points: list[list[int]], links: list[Link], window: int) -> object:
    """Return the successors without the nodes that have none."""
    return {node: ends for node, ends in right_successors_of(points, links, window).items() if ends}


def mistake_both_directions(points: list[list[int]], links: list[Link], window: int) -> object:
    """Add the reverse of each transition, from (target, enter + window) to (source, leave)."""
    back = [(target, enter + window, source, leave - window) for source, leave, target, enter in links]
    return right_successors_of(points, [*links, *back], window)


def mistake_without_stretches(points: list[list[int]], links: list[Link], window: int) -> object:
    """Join the two ends of each transition, and leave out the edges along the clips."""
    following = nodes_of(points)
    for source, leave, target, enter in links:
        following.setdefault((source, leave), []).append((target, enter + window))
    return following


def mistake_frames_alone(points: list[list[int]], links: list[Link], window: int) -> object:
    """Return the successors of each node as frames, without their clips."""
    return {
        node: [frame for _, frame in ends]
        for node, ends in right_successors_of(points, links, window).items()
    }


def mistake_transitions_replace_stretches(points: list[list[int]], links: list[Link], window: int) -> object:
    """Replace all edges that already leave a node by each transition that leaves it."""
    following = right_successors_of(points, [], window)
    for source, leave, target, enter in links:
        following[source, leave] = [(target, enter + window)]
    return following


def mistake_first_clip_alone(points: list[list[int]], links: list[Link], window: int) -> object:
    """Return the successors of the nodes of the first clip."""
    return {node: ends for node, ends in right_successors_of(points, links, window).items() if node[0] == 0}


def mistake_predecessors(points: list[list[int]], links: list[Link], window: int) -> object:
    """Return, for each node, the nodes whose edges lead to it."""
    following = right_successors_of(points, links, window)
    leading = nodes_of(points)
    for node, ends in following.items():
        for end in ends:
            leading.setdefault(end, []).append(node)
    return leading


def mistake_each_successor_once(points: list[list[int]], links: list[Link], window: int) -> object:
    """Return the successors in order and each once, which loses parallel edges."""
    return {node: sorted(set(ends)) for node, ends in right_successors_of(points, links, window).items()}


def mistake_same_clip(points: list[list[int]], links: list[Link], window: int) -> object:
    """Lead each transition into the clip that it leaves."""
    return right_successors_of(
        points, [(source, leave, source, enter) for source, leave, _, enter in links], window
    )


def mistake_window_at_start(points: list[list[int]], links: list[Link], window: int) -> object:
    """Join (source, leave + window) to (target, enter): the window is added at the wrong end."""
    moved = [(source, leave + window, target, enter - window) for source, leave, target, enter in links]
    return right_successors_of(points, moved, window)
