"""Trials of the constants of path following: `python figures/tune/steering.py [--quick]`.

Walks through the clips' graph follow lines on the ground. Off and worst: the mean and the largest distance of
the walks from the lines; good walks have less than 4 and 15 cm. Seams: transitions per second. Takes: the
duration of a walk.

- The search: an s-curve and a circle.
- Its repetitions: a narrow s-curve and a small circle, which the first try does not follow.
- Judging: what part of the walks along four lines is good, and the CPU time, as searches are repeated until a
  walk is. `not_followed`: the number of lines that are refused, of six, of which clips hardly turn four.
- Bent walks: the same two lines, with the walk laid on the line. Short: the distance of the walk's last frame
  from the end of the line. `idle_price`: two clips of which one stands for long. `slowest`, `grace` and
  `creep`: the same two, played at 0.6 to 0.2 times their pace. Refused: how many of these have no walk.
- Control: a figure that is turned about its root by commands, for half a minute; see `judge_control`.
- Held feet: figures that are turned about their roots on a graph and by matching, by three sets of commands
  for 20 s each. Slide: the largest of a stance, and the mean. Jolting: frames above 99.9 % of the clips'.
  Jump: the 99.9 % of the changes of velocity, of the clips'. `held_feet.md` has the table of `foot_halflife`.
- Crowds: two who cross. Nearest: the least distance between them, which should be 80 cm; waits: the sum of
  both. `passing`: the distance of a walk from waypoints at the moments that count as passed.
"""

from dataclasses import replace

import numpy as np
from _trials import CAPTURED_WALKS, RATE, STOP_AND_GO, Clips, Collection, Row, Study, Trial
from _walks import PATHS, compiled, followed, graph_of, measures

from mocap._shared.arrays import Array
from mocap.body import SHAPES, GroundPath, circle, resample, s_curve
from mocap.editing import LIMIT
from mocap.errors import NoWalk
from mocap.feet import mark_plants
from mocap.files import DirectedPoint, Direction
from mocap.methods.motion_matching import MotionMatcher, tabulate
from mocap.quality import foot_sliding, jumps, spread
from mocap.quality.seam_measures import USUAL
from mocap.steering import (
    Controller,
    RootTurner,
    Waypoint,
    command_headings,
    direct,
    follow_path,
    judge_control,
    steer,
    through_waypoints,
    tuned,
    walk_crowd,
)

NARROW = (s_curve(2.5), circle(0.8))
SEVERAL = (*PATHS, s_curve(4.0), SHAPES["square"]())
HARD = (circle(0.3), circle(0.5), circle(0.7), s_curve(2.0), *PATHS)
STANDING_UP = [DirectedPoint(0, 0), DirectedPoint(0, 4, wait=1.0), DirectedPoint(3, 6)]
AHEAD = [DirectedPoint(0, 0), DirectedPoint(0, 6)]
DIRECTIONS = (
    Direction(STANDING_UP, "stand", "stand", facing=0.0),
    Direction(AHEAD, "stand", "stand", around=[(0.1, 3, 0.6)]),
    Direction(AHEAD, "stand", "stand", facing=0.4),
)
PACES = (0.6, 0.4, 0.3, 0.2)  # times the pace of clips that stand, and walk at 1.3 m/s
STANDING = Collection("clips that stand and walk", ("stop_and_go", "walk_straight"))
CROSSING = (GroundPath([[0, 0], [0, 6]]), GroundPath([[3, 3], [-3, 3]]))
WAYPOINTS = (Waypoint(0, 0), Waypoint(0.5, 4), Waypoint(-1.5, 7), Waypoint(-1.5, 11))


def search(clips: Clips) -> Row:
    """Follow two lines that clips can turn."""
    return measures(followed(compiled(clips)))


def repeated(clips: Clips) -> Row:
    """Follow two lines that one search does not follow."""
    return measures(followed(compiled(clips), paths=NARROW))


def judged(clips: Clips) -> Row:
    """Count the good ones among four walks."""
    walks = followed(compiled(clips), paths=SEVERAL)
    return {"good, %": 100 * float(np.mean([walk.excess <= 1 for walk in walks]))} | measures(walks)


def judged_bent(clips: Clips) -> Row:
    """Count the good ones among three bent walks."""
    walks = followed(compiled(clips), bend=LIMIT, paths=SEVERAL[:3])
    return {"good, %": 100 * float(np.mean([walk.excess <= 1 for walk in walks]))} | measures(walks)


def refused(clips: Clips) -> Row:
    """Count lines that are refused, and measure the walks along the others."""
    walks = []
    for path in HARD:
        try:
            walks.append(follow_path(compiled(clips), path))
        except NoWalk:
            continue
    return {"refused": len(HARD) - len(walks)} | measures(walks)


def bent(clips: Clips) -> Row:
    """Lay walks on two lines."""
    walks = followed(compiled(clips), bend=LIMIT)
    short = [walk.motion().root_positions[-1, [0, 2]] - walk.path.points[-1] for walk in walks]
    return {"short, cm": 100 * float(np.linalg.norm(short, axis=1).max())} | measures(walks)


def pausing(clips: Clips) -> Row:
    """Lay walks with pauses on two lines."""
    return measures(
        followed(compiled(STANDING.load() or ()), bend=LIMIT, paths=(SHAPES["letter S"](), circle(0.8)))
    )


def slowed(clips: Clips) -> Row:
    """Lay walks that are played more and more slowly on a line."""
    walks = []
    for pace in PACES:
        played = tuple(replace(clip, fps=pace * clip.fps) for clip in STANDING.load() or ())
        graph = compiled(tuple(resample(clip, RATE) for clip in played))
        try:
            walks.append(follow_path(graph, PATHS[0], bend=LIMIT))
        except NoWalk:
            continue
    return {"refused": len(PACES) - len(walks)} | (measures(walks) if walks else {})


def crossing(clips: Clips) -> Row:
    """Let two characters cross."""
    crowd = walk_crowd(graph_of(clips), CROSSING)
    return {"nearest, cm": 100 * float(crowd.nearest.min()), "waits, s": sum(crowd.waits)}


def passed(clips: Clips) -> Row:
    """Walk through waypoints, and measure how far they are missed."""
    walk, arrivals = through_waypoints(graph_of(clips), WAYPOINTS)
    return {"missed, cm": 100 * max(arrival.off for arrival in arrivals)} | measures([walk])


def commanded(clips: Clips) -> Row:
    """Turn a character by commands, about its root."""

    def character() -> RootTurner:
        return RootTurner(Controller(compiled(clips)))

    report = judge_control(character, spread(list(clips)), speed=1.0, seconds=30.0)
    return {
        "obeys, s": report.delay.mean,
        "slide, cm": report.slide,
        "jolting, %": 100 * report.jolting,
        "wags, degrees": report.wags,
    }


def held(clips: Clips) -> Row:
    """Turn characters on a graph and by matching by three sets of commands, and measure what feet do."""
    marked = [clip if clip.contacts else mark_plants(clip) for clip in clips]
    usual = float(np.percentile(spread(marked).within(1), USUAL))
    halflife = tuned.TUNED.foot_halflife
    distances: list[float] = []
    changes: list[Array] = []
    for seed in range(3):
        headings = command_headings(20.0, RATE, seed)
        for character in (Controller(compiled(clips)), MotionMatcher(tabulate(marked))):
            motion = steer(RootTurner(character, halflife=halflife), headings, speed=1.0).motion
            stances = [stance for stance in foot_sliding(motion) if stance.stop - stance.start > 2]
            distances += [stance.distance for stance in stances]
            changes.append(jumps(motion))
    jump = np.concatenate(changes)
    row: Row = {"worst slide, cm": max(distances), "slide, cm": float(np.mean(distances))}
    row |= {"jolting, %": 100 * float(np.mean(jump > usual))}
    return row | {"jump": float(np.percentile(jump, USUAL)) / usual}


def directed(clips: Clips) -> Row:
    """Follow directions that start, wait and end standing, one of them around a disc."""
    graph = graph_of(clips).source
    walks = []
    for direction in DIRECTIONS:
        try:
            walks.append(direct(graph, direction))
        except NoWalk:
            continue
    corrected = [part for walk in walks for part in walk.corrections]
    row: Row = {"found": len(walks)}
    row |= {"spread, cm": 100 * max((part.metres for part in corrected), default=0.0)}
    return row | {"spread, °": float(np.degrees(max((abs(part.radians) for part in corrected), default=0.0)))}


def timed(clips: Clips) -> Row:
    """Follow a direction with two times, from a stand."""
    points = [DirectedPoint(0, 0), DirectedPoint(0, 4, t=6.0), DirectedPoint(4, 5, t=11.0)]
    walk = direct(graph_of(clips).source, Direction(points, start="stand", end="stand"))
    late = max(abs(arrival.late) for arrival in walk.arrivals if arrival.point.t is not None)
    return {"late, s": late, "spread, cm": 100 * max(part.metres for part in walk.corrections)}


# reads: statement: a table
TRIALS = {
    "route_spacing": Trial(search, (0.2, 0.005, 0.01, 0.05)),
    "layer": Trial(search, (0.6, 0.05, 0.1, 0.3)),
    "reach": Trial(search, (0.1, 0.25, 1.0, 3.0)),
    "wide_beam": Trial(repeated, (100, 200, 800)),
    "lower_seam_prices": Trial(repeated, ((), (1 / 3,), (0.0,), (1 / 2, 1 / 4, 0.0))),
    "seam_price_step": Trial(repeated, (2.0, 1.0, 1.1, 1.5)),
    "leaves_path": Trial(judged, (0.1, 0.05, 0.2, 0.3)),
    "mean_distance": Trial(judged, (0.03, 0.02, 0.06, 0.1)),
    "seam_rate": Trial(judged, (0.7, 0.5, 1.5, 2.0)),
    "bent_seam_rate": Trial(judged_bent, (0.4, 0.5, 1.0)),
    "not_followed": Trial(refused, (0.1, 0.3, 3.0)),
    "idle_price": Trial(pausing, (0.0, 0.001, 0.01, 1.0), needs_clips=False),
    "slowest": Trial(slowed, (0.6, 0.0, 0.15), needs_clips=False),
    "grace": Trial(slowed, (0.0, 1.0, 2.0, 8.0), needs_clips=False),
    "creep": Trial(slowed, (0.3, 0.01, 0.1), needs_clips=False),
    "overrun": Trial(bent, (0.0, 0.2, 1.0)),
    "overrun_fraction": Trial(bent, (0.0, 0.01, 0.05)),
    "clock": Trial(crossing, (1, 2, 8)),
    "wider_views": Trial(crossing, ((0, 0, 0), (0, 1, 1), (0, 2, 4))),
    "waits": Trial(crossing, ((0.0,), (0.0, 2.0), (0.0, 0.5, 1.0, 1.5, 2.0, 4.0))),
    "crowd_beam": Trial(crossing, (30, 50, 200)),
    "wait_step": Trial(crossing, (0.25, 1.0)),
    "detours": Trial(crossing, (0, 1)),
    "passing": Trial(passed, (0.2, 0.0, 0.05)),
    "rotation_price": Trial(commanded, (0.0, 0.1, 0.6)),
    "turned_seam": Trial(commanded, (1.0, 6.0)),
    "pace_price": Trial(commanded, (0.0, 3.0, 12.0)),
    "largest_rotation": Trial(held, (100.0, 1.2, 2.0)),
    "foot_halflife": Trial(held, (0.1, 0.12, 0.3)),
    "heel_halflife": Trial(held, (0.05, 0.2)),
    "hip_halflife": Trial(held, (0.05, 0.2)),
    "lowest_hips": Trial(held, (0.0, 0.1)),
    "soft_reach": Trial(held, (0.95, 0.99)),
    "longest_reach": Trial(held, (0.99, 1.0)),
    "steepest_foot": Trial(held, (0.79, 1.57)),
    "turned_ahead": Trial(commanded, (3.0, 1.0, 2.0)),
    "standing_seconds": Trial(directed, (0.2, 0.6)),
    "starting_seconds": Trial(directed, (0.2, 1.0)),
    "standing_nodes": Trial(directed, (1, 6)),
    "standing_seam": Trial(directed, (0.03, 0.1)),
    "clearances": Trial(directed, ((0.4, 0.4), (1.0, 0.4))),
    "settled_seconds": Trial(directed, (0.0, 0.4)),
    "arrival": Trial(directed, (0.3, 0.6, 2.0)),
    "starting_metres": Trial(timed, (0.0, 0.25, 1.0)),
    "pace_percentiles": Trial(timed, ((25.0, 75.0), (50.0, 99.0), (75.0, 90.0))),
    "overshoot": Trial(directed, (0.5, 3.0)),
    "turned_from": Trial(directed, (0.2, 1.0)),
}
FIXED = {"walking_speed": "an error tells which clips walk; no search reads it"}
STUDY = Study(tuned, TRIALS, FIXED, (STOP_AND_GO, CAPTURED_WALKS))

if __name__ == "__main__":
    STUDY.main(__doc__)
