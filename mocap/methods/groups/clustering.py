"""Nodes of a group graph: configurations that come again and again in a simulation [LCF05]."""

import warnings
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask
from mocap.errors import MocapError, MocapWarning
from mocap.methods.groups.configurations import Configuration, compare, seen_from_itself
from mocap.methods.groups.flocking import RATE, Trajectories

EVERY = 1.0  # seconds between the frames that are looked at
COVERED = 0.8  # a smaller share of the simulation near a node is warned of


class Clusters(NamedTuple):
    """Nodes, which frame each was, and the share of the simulation within `reach` of one.

    `distances` (S, S), metres: of any two of the S frames that were looked at.
    """

    nodes: tuple[Configuration, ...]
    frames: Indices
    covered: float
    distances: Array


def cluster(flock: Trajectories, *, nodes: int = 8, reach: float = 0.5) -> Clusters:
    """Choose configurations that come again [LCF05, nodes]; how is ours.

    Each time the one with the most others within `reach` that no node has yet. Comparing is O(S² N³) for S
    frames of N members: this is the longest part of building a graph.

    Parameters
    ----------
    flock : as `simulate` gives it.
    nodes : how many to choose at most; fewer where all are covered.
    reach : metres, RMS.

    Raises
    ------
    MocapError : for no frames, less than one node, a reach not above 0, and a group that stands.

    Warns
    -----
    MocapWarning : where less than 80 % of the simulation are within `reach` of a node.

    Examples
    --------
    >>> from mocap.methods.groups.flocking import simulate
    >>> found = cluster(simulate(4, 60), nodes=4, reach=0.4)
    >>> len(found.nodes), found.covered > 0.8
    (4, True)

    Notebook: 19-group-graphs
    """
    if not len(flock.places):
        raise MocapError("There is no frame to take nodes from.")
    if not (nodes >= 1 and reach > 0):
        raise MocapError(f"Clusters take a node or more and a reach above 0; got {nodes}, {reach} m.")
    step = round(EVERY * RATE)
    seen, _, _ = seen_from_itself(Configuration(flock.places[::step], flock.velocities[::step]))
    distances = _distances(seen)
    free: Mask = np.ones(len(distances), bool)
    chosen: list[int] = []
    while len(chosen) < nodes and free.any():
        best = int(((distances < reach) & free).sum(axis=1).argmax())
        chosen.append(best)
        free &= distances[best] >= reach
    covered = 1 - float(free.mean())
    if covered < COVERED:
        warnings.warn(
            f"{len(chosen)} nodes are within {reach:g} m of {covered:.0%} of what was simulated: "
            "take more nodes, or a larger reach.",
            MocapWarning,
            stacklevel=2,
        )
    kept = tuple(Configuration(seen.places[row], seen.velocities[row]) for row in chosen)
    return Clusters(kept, np.array(chosen) * step, covered, distances)


def _distances(seen: Configuration) -> Array:
    """Compare each configuration with all before it, from the direction of the velocities alone."""
    table = np.zeros((len(seen.places),) * 2)
    for row in range(1, len(table)):
        one = Configuration(seen.places[row], seen.velocities[row])
        before = Configuration(seen.places[:row], seen.velocities[:row])
        table[row, :row] = table[:row, row] = compare(one, before, starts=(0.0,), rounds=2).rms
    return table
