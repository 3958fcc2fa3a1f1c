"""Constants of match webs that trials chose; `figures/tune/match_webs.py` runs the trials again."""

from __future__ import annotations

from mocap._shared.records import dataclass


@dataclass(frozen=True)
class Tuned:
    """Each constant with its unit, and the reason for its value."""

    # Paths in a grid of distances
    slope: int = 2  # frames of one clip at most that are aligned with one frame of the other
    least_advance: int = 9  # frames that a path advances in each clip, 0.3 s. Shorter ones are chance
    near_path: int = 3  # frames. A path is left out if more than half of it is this near to a better one
    off_minimum: float = 0.5  # times `below`, added to the cost of a cell that is no one-dimensional minimum
    part_rows: int = 600  # windows on a side of a part of a grid. Smaller parts cut long paths
    part_columns: int = 4000  # windows on its other side. Larger parts take more memory

    # A search of matches
    same_match: float = 0.5  # overlap, as a fraction of the union. At 0.9 one motion is found many times
    cover: float = 0.9  # fraction of a stretch that a path must cover. At 0.5 two of five matches are wrong
    leak: float = 5  # a step leaks if it finds more than so many times the matches of the previous step
    few_matches: int = 20  # a step that finds no more does not leak

    # Weights of samples for a target
    convex: int = 12  # nearest samples that are mixed. 3 miss targets by seven times as much
    ridge: float = 5e-4  # preference for near samples. At 0.05 targets are missed by more


TUNED = Tuned()
