"""Flocks and group motion graphs."""

from functools import cache

import numpy as np

from mocap import body
from mocap.methods import groups
from tests.bundled import walking
from tests.frozen.quantities import FRAME, case, numbers

MET = np.linspace(20, 14, 7)[:, None] + [0.6j, -0.6j]
WALL = groups.Scene((4 - 3j, 18 + 0j, 14 - 3j), [(9 + 1.5j * k, 0.6) for k in range(-2, 3)], 0.6, 0.3, [MET])
HERE = body.PlanarTransform(0.4, 0.5, -1.0)
BEHIND = groups.Scene((-9 + 0j,), ((-4 + 0.4j, 0.5),), others=(np.array([[9j], [-7 + 0.5j]]),))


@cache
def group():
    return groups.build_group(3, nodes=1, corridors=(1.5,), simulated=40.0, reach=0.4)


def tracks(places, velocities):
    return {
        "positions": numbers(places, FRAME, "member", unit="m"),
        "velocities": numbers(velocities, FRAME, "member", unit="m/s"),
    }


@case("flock")
def flock():
    return tracks(*groups.simulate(5, 10, seed=1))


@case("flock between walls")
def flock_between_walls():
    return tracks(*groups.simulate(5, 10, corridor=6.0, seed=2))


@case("group")
def clips_of_group():
    clips = group().clips
    places, velocities = (
        np.concatenate([getattr(clip, part) for clip in clips]) for part in ("positions", "velocities")
    )
    return {
        "nodes": numbers([(clip.start, clip.end) for clip in clips], "clip", "end"),
        **tracks(places, velocities),
        "orders": numbers([clip.order for clip in clips], "clip", "slot"),
        "rotations": numbers([clip.rotation for clip in clips], "clip"),
        "translations": numbers([clip.translation for clip in clips], "clip", unit="m"),
    }


@case("planned group")
def planned_group():
    plan = groups.plan_group(group(), WALL, weight=1.3)
    clips, *costs = plan
    played = groups.play_group(group(), clips)
    return {**tracks(*played), "plan": numbers(costs, "number")}


@case("led group")
def led_group():
    quantities = {}
    for name, scene in {"to a wall": WALL, "behind": BEHIND}.items():
        led = groups.lead_group(group(), scene, start=HERE)[0]
        quantities |= {f"{part} {name}": values for part, values in tracks(*led).items()}
    return quantities


@case("steered group")
def steered_group():
    return tracks(*groups.steer_group(group().nodes[0], WALL, limit=30.0)[0])


@case("walked group")
def walked_group():
    walked = groups.walk_group(walking(), groups.simulate(2, 3, seed=2))
    return {
        "tracks": numbers(walked.tracks, FRAME, "member", unit="m"),
        "targets": numbers(walked.targets, FRAME, "member", unit="m"),
    }


@case("clusters")
def clusters():
    chosen, share, distances = groups.cluster(groups.simulate(5, 30), nodes=3, reach=0.4)[1:]
    return {
        "nodes": numbers(chosen, "node"),
        "share": numbers(share),
        "distances": numbers(distances, "configuration", "other configuration"),
    }


@case("matched groups")
def matched_groups():
    flock = groups.simulate(8, 10)
    halves = np.split(np.array(flock), 2, axis=1)
    match = groups.compare(*(groups.Configuration(*half) for half in halves))
    distances, orders, rotations, translations = match
    return {
        "distances": numbers(distances, "pair"),
        "orders": numbers(orders, "pair", "member"),
        "rotations": numbers(rotations, "pair"),
        "translations": numbers(translations, "pair", unit="m"),
    }


@case("group that bends")
def bending_group():
    flock = groups.simulate(3, 4)
    end = groups.Configuration(flock.positions[-1] + [1, 2j, -1], flock.velocities[-1] * 1j)
    return {"positions": numbers(groups.bend_to(flock, end), FRAME, "member", unit="m")}
