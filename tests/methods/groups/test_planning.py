"""Plans pass all points and clear all obstacles; characters walk a plan in place and in time."""

from functools import cache
from itertools import product

import numpy as np
import pytest

from mocap.body.planar import IDENTITY, PlanarTransform, heading
from mocap.errors import MocapError, NoWalk
from mocap.methods.groups.flocking import APART, RATE, Configuration, Flock, nearest_two
from mocap.methods.groups.group_graphs import play_group, random_group_walk
from mocap.methods.groups.group_steering import clearances, lead_group, steer_group
from mocap.methods.groups.group_walkers import walk_group
from mocap.methods.groups.planning import Scene, Search, plan_group
from mocap.quality.seam_measures import sliding_per_frame
from tests.bundled import bundled
from tests.methods.groups.built import around, course, gap, graph, pocket
from tests.refusals import refusals, unwarned


def walked(found, start=IDENTITY):
    """What the group does until it passes the last point."""
    played = play_group(graph(), found.clips, start)
    return Configuration(*(part[: round(found.seconds * RATE) + 1] for part in played))


def passed(flock, scene):
    """Count the points that the middle passes, in order."""
    middle, goal = flock.positions.mean(axis=1), 0
    for place in middle:
        while goal < len(scene.points) and abs(place - scene.points[goal]) < scene.radius:
            goal += 1
    return goal


def all_is_well(flock, scene):
    """Whoever is passed, clear and apart goes well."""
    assert passed(flock, scene) == len(scene.points)
    assert clearances(flock, scene).min() >= scene.body - 1e-9
    assert nearest_two(flock.positions).min() >= APART


def planned(scene, **settings):
    """Plan for twelve."""
    found = plan_group(graph(), scene, **settings)
    all_is_well(walked(found), scene)
    return found


@pytest.mark.parametrize("seed", [5, 8])
def test_courses_are_found_and_every_one_is_clear(seed):
    """As in [LCF05, search]."""
    planned(course(seed))


def best_of_steered(scene, best, seeds, avoids=(0.8, 1.2, 2.0), gathers=(0.35, 1.0)):
    """Seconds of the soonest flock that steers and keeps clear, at most `best`; seed None has no whims."""
    for avoid, gather, seed in product(avoids, gathers, seeds):
        rules = Flock(avoid=avoid, gather=gather, whim=0.0 if seed is None else 0.5)
        flock, points = steer_group(graph().nodes[0], scene, rules=rules, seed=seed or 0, limit=best)
        clear = clearances(flock, scene).min() >= scene.body and nearest_two(flock.positions).min() >= APART
        if points == len(scene.points) and clear:
            best = (len(flock.positions) - 1) / RATE
    return best


LED = [*map(around, (0, 6, 8, 20)), gap(2, 16 + 0j), gap(2.5, 14 - 1j), gap(2.5, 16 + 0j, 10.0)]


@pytest.mark.parametrize("scene", LED)
def test_whoever_leads_by_the_quicker_way_is_never_later_than_steered(scene):
    """Plans alone are later in half of the scenes: clips turn by 1.2 rad in four seconds, a flock at once."""
    flock, _ = lead_group(graph(), scene)
    all_is_well(flock, scene)
    seconds = (len(flock.positions) - 1) / RATE
    assert seconds <= best_of_steered(scene, seconds, [None])
    assert seconds <= best_of_steered(scene, seconds, range(3), [2.0], [0.35])
    assert seconds <= best_of_steered(scene, seconds, range(3)) + 0.25  # of 18 with whims one may be lucky


def test_both_plans_and_flocks_that_steer_lead():
    assert {lead_group(graph(), scene)[1] is None for scene in (around(0), around(20))} == {False, True}


def test_a_flock_that_would_not_keep_clear_does_not_lead():
    """Nor does one that stays in a pocket, or runs into another group; where there is no plan, it is said."""
    assert lead_group(graph(), pocket(1.5))[1]
    aside = around(0)._replace(discs=())
    flock, plan = lead_group(graph(), aside)
    met = flock.positions[80].mean() + np.zeros((1, 1))
    assert plan is None and np.abs(flock.positions - met).min() < APART
    careful, plan = lead_group(graph(), aside._replace(others=(met,)))
    assert plan and np.abs(careful.positions - met).min() >= APART
    with pytest.raises(NoWalk, match="the limit of 100 states ended the search"):
        lead_group(graph(), pocket(4.5), most=100)


def test_bounds_spare_most_tests():
    """As in [LCF05, search; bounds]."""
    found = plan_group(graph(), course(5))
    assert found.spared >= 0.7 * (found.spared + found.tested) > 1000


def test_a_plan_leaves_the_pocket_that_steering_never_leaves():
    scene = pocket(1.5)
    planned(scene, weight=3.0)
    stuck, points = steer_group(graph().nodes[0], scene, limit=60.0)
    assert points == 0 and stuck.positions[-1].real.mean() < 16


def test_more_weight_finds_a_way_with_fewer_states():
    few, many = (plan_group(graph(), course(8), weight=weight).expanded for weight in (2.0, 1.0))
    assert few < many / 4


def test_two_groups_pass_each_other():
    """The second plans around the first, frame by frame, and needs more than the bounds to know."""
    first = walked(plan_group(graph(), Scene((24 + 0j,))))
    back = PlanarTransform(np.pi, 0.0, 24.0)
    alone = plan_group(graph(), Scene((0j,)), start=back)
    careful = plan_group(graph(), Scene((0j,), others=tuple(first.positions.T[:, :, None])), start=back)

    def least(found):
        flock = walked(found, back)
        frames = np.minimum(np.arange(len(flock.positions)), len(first.positions) - 1)
        return np.abs(flock.positions[:, :, None] - first.positions[frames][:, None]).min()

    assert least(alone) < APART <= least(careful)
    assert careful.spared > 0


def test_what_a_refusal_advises_helps():
    """Turned by half a radian, past a point beside the pocket, through a gap as it says, or as fewer."""
    rock = Scene((20 + 0j,), ((4.2 + 0j, 1.5),))
    with pytest.raises(NoWalk, match=r"closed every path\. Start farther off or turned, take fewer members"):
        plan_group(graph(), rock)
    assert plan_group(graph(), rock, start=PlanarTransform(-0.5, 0.0, 0.0)) and plan_group(graph(3), rock)
    with pytest.raises(NoWalk, match="Add a point before it, allow more states"):
        plan_group(graph(), pocket(4.5), most=100)
    scene = pocket(4.5)
    assert plan_group(graph(), Scene((10 + 8j, *scene.points), scene.discs), most=100)
    with pytest.raises(NoWalk, match=r"take fewer members, or leave gaps of 1.9 m\.$"):
        plan_group(graph(), gap(1.6, 16 + 0j), most=300)
    assert plan_group(graph(), gap(1.9, 16 + 0j), most=700)
    assert plan_group(graph(3), gap(1.6, 16 + 0j), most=300)


SCENES = (
    (Scene(()), "finite points z .* to pass, one or more"),
    (Scene(((3, 3),)), r"finite points z \+ ix to pass, one or more, from a start; got \(\(3, 3\),\)"),
    (Scene((complex(np.nan),)), "finite points"),
    (Scene((9j,), ((5j, 0.0),)), "a radius above 0"),
    (Scene((9j,), ((complex(np.inf), 1.0),)), "An obstacle has a centre"),
    (Scene((9j,), ((0.2 + 0.1j, 1.0),)), "starts inside the obstacle at x=0.1, z=0.2"),
)
RING = tuple((3.5 * np.exp(2j * np.pi * k / 16), 0.8) for k in range(16))


def plan(*scene, **settings):
    return plan_group(graph(), Scene(*scene), **settings)


test_scenes_that_make_no_sense_or_have_no_way_are_refused = refusals(
    *((words, lambda scene=scene: plan_group(graph(), scene)) for scene, words in SCENES),
    *((words, lambda scene=scene: steer_group(graph().nodes[0], scene)) for scene, words in SCENES),
    (NoWalk, "No path past point 1 of 1 was found: obstacles closed every path", plan, (20 + 0j,), RING),
    (NoWalk, "past point 2 of 2 was found: the limit of 5 states", lambda: plan((4 + 0j, 20 + 0j), most=5)),
    (
        NoWalk,
        r"Member 4 starts -0.20 m from the rim .*: 0.3 m is the least",
        lambda: plan((9 + 0j,), ((complex(graph().nodes[0].positions[3]), 0.2),)),
    ),
)


def free_one_by_one(group, node, rotation, translation, frame, scene):
    """Lay each clip on the ground, and look at all members in all frames; `Search` looks at once."""
    kept = []
    for number in group.leaving(node):
        places = rotation * group.clips[number].positions + translation
        clear = all((np.abs(places - spot) >= size + scene.body).all() for spot, size in scene.discs)
        for other in scene.others:
            there = other[np.minimum(frame + np.arange(len(places)), len(other) - 1)]
            clear = clear and (np.abs(places[:, :, None] - there[:, None]) >= APART).all()
        if clear:
            kept.append(number)
    return kept


def test_all_clips_at_once_are_as_free_as_one_by_one():
    random, group, found = np.random.default_rng(0), graph(), []
    others = (np.linspace(20, 0, 150)[:, None] + np.array([1j, -1j]),)
    scene = Scene((9 + 0j,), course(5).discs, others=others)
    search = Search(group, scene)
    for _ in range(40):
        node, frame = int(random.integers(len(group.nodes))), int(random.integers(200))
        spot = random.choice(scene.discs)[0] + random.normal(0, 5)
        turn = np.exp(1j * random.uniform(-3, 3))
        free = search.free(node, turn, spot, frame).tolist()
        assert free == free_one_by_one(group, node, turn, spot, frame, scene)
        found.append(len(free))
    assert min(found) < 10 and max(found) > 150


SCENE = Scene((8 + 0j, 14 + 5j), ((11 - 1.5j, 0.6),))


@cache
def led():
    group = graph(6, 6)
    found = plan_group(group, SCENE)
    frames = round(found.seconds * RATE) + 1
    return Configuration(*(part[:frames] for part in play_group(group, found.clips)))


@cache
def walkers():
    return unwarned(
        walk_group, bundled("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight"), led()
    )


def test_each_is_where_it_should_be_by_then():
    """The sway of the hips is part of it."""
    assert walkers().errors.mean() <= 0.05 and np.percentile(walkers().errors, 95) <= 0.10
    assert walkers().nearest >= 0.75
    assert "6 characters, 13.7 s" in walkers().report()


def test_they_last_as_long_as_the_plan_and_wanted_is_the_led():
    assert {len(motion) for motion in walkers().motions} == {len(walkers().targets)}
    np.testing.assert_allclose(walkers().targets[::3], led().positions, atol=1e-9)


def test_planted_feet_stand():
    for motion in walkers().motions:
        assert sliding_per_frame(motion).max() < 1e-4
        planted = np.mean([mark.mean() for mark in motion.contacts.values()])
        assert planted > 0.3  # of the clips' own 0.35


def test_they_face_where_they_go():
    for motion, way in zip(walkers().motions, walkers().tracks.T, strict=True):
        off = np.angle(np.gradient(way) * np.exp(-1j * heading(motion.rotations[:, 0])))
        assert np.abs(off[15:-15]).mean() < np.radians(15)


def test_the_bare_lines_bring_them_together_and_out_of_time():
    """Without bending, characters of slow clips come late."""
    two = Configuration(led().positions[:81, :2], led().velocities[:81, :2])
    loose, bent = (walk_group(bundled("sneak"), two, bend=bend) for bend in (False, True))
    assert loose.errors.mean() > 3 * bent.errors.mean()


@pytest.mark.parametrize(("some", "got"), [(np.s_[:10, :], "6 and 0.9 s"), (np.s_[:, :0], "0 and 13.7 s")])
def test_a_plan_for_nobody_or_of_less_than_a_second_is_refused(some, got):
    with pytest.raises(MocapError, match=f"a member or more and lasts 1 s or more, got {got}: does it lead"):
        walk_group(bundled("walk_curve_1"), Configuration(*(part[some] for part in led())))


def test_who_stands_at_the_end_is_carried_on_all_the_same():
    places = led().positions.copy()
    places[-11:] = places[-11]
    walked = walk_group(bundled("walk_circle", "walk_curve_1"), Configuration(places[:, :2], places[:, :2]))
    assert len(walked.motions[0]) == len(walked.targets)


def test_a_way_of_any_length_can_be_walked():
    """Ways whose length rounds below the sum of their steps: a place to pass lies at the path's very end."""
    group = graph(6, 6)
    for seed in range(4):
        played = play_group(group, random_group_walk(group, 1, seed=seed))
        one = Configuration(played.positions[:, :1], played.velocities[:, :1])
        assert walk_group(bundled("walk_circle", "walk_curve_1"), one).errors.mean() < 0.1
