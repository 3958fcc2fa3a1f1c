"""Constants of in-betweening that trials chose; `figures/tune/in_betweening.py` runs the trials again."""

from __future__ import annotations

import math

from mocap._shared.records import dataclass


@dataclass(frozen=True)
class Tuned:
    """Each constant with its unit, and the reason for its value."""

    # Walks that are tried, and their ends
    # Of 24 requests anywhere, 2 have no walk that arrives among the first 24, and one of these has two among
    # the first 72. More take tens of seconds to refuse.
    tried: int = 24  # walks that are bent at a time, while none arrives. The best that arrives is taken
    most_tried: int = 72  # walks that are bent at most
    pose: float = 0.1  # metres, RMS, by which joints may be moved where the ends fade into the poses
    # The clean-up may release what it should hold at the ends, by up to 1° of a joint. Feet then slide by up
    # to 0.3 mm. After the second round most do not. Where a straight leg makes the clean-up lower the root
    # near an end, 1 mm is left, which `put_back` removes.
    rounds: int = 4  # times that feet are cleaned up and ends brought to the poses
    fade: float = 0.5  # seconds in which a residual fades, at most. In a shorter walk, half of it
    near_end: float = 0.3  # seconds. A footplant so near to an end keeps its position at the frame next to it

    # The search from both ends
    ahead: float = 0.1  # seconds from a pose to the one before or after it, and between two candidates
    candidates: int = 6  # frames of the clips that are tried for each pose
    # Costs of a walk beside `turn` and `stretch`
    seam: float = 0.5  # for each seam, as much as for a second turned by 57° per second
    match: float = 300.0  # times the squared distance of a seam, m²
    end_pose: float = 100.0  # times the squared distance of the end poses, m²
    beyond_limit: float = 100.0  # for each radian per second, or unit of a step's logarithm, beyond its limit
    layer: float = 0.1  # seconds. Walks in one layer compete
    beam: int = 400  # walks that stay in a layer
    cell: float = 0.1  # metres: walks at one node in one cell are similar
    angle: float = 0.15  # radians: the same for their directions
    meeting: int = 3000  # walks from the start that are joined with those from the end
    pairs: int = 3_000_000  # joins that are compared, at most

    # Bending the ends of a walk
    most_rotation: float = math.radians(60)  # radians per second of turning, added to the walk's own
    most_steps: float = 1.25  # times: steps become longer or shorter by at most this factor
    most_pace: float = 1.25  # times: the walk is played faster or slower by at most this factor
    rotation: float = 0.5  # times the squared radians per second of added turning, times seconds
    stretch: float = 8.0  # times the squared logarithms of the step factor and of the pace, times seconds
    within: float = 0.98  # of the limit of turning, because only some frames are constrained
    solver_rounds: int = 30  # iterations. 5 to 15 are enough if there is a solution
    knots: float = 0.3  # seconds between the knots of φ and ln σ
    fewest_spans: int = 10  # spans between knots
    most_spans: int = 40  # spans between knots
    per_span: int = 4  # frames between two knots at which the turning is constrained. Fewer let it exceed
    rise: float = 0.15  # the part of a walk, at each end, over which its time reaches the new pace


TUNED = Tuned()
