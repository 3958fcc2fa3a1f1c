"""Strides are cut where feet strike, and mixed by what the body feels, not by where it is."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from mocap.body import Motion, joint_positions, place, resample
from mocap.body.rotations import multiply
from mocap.datasets.samples import sample
from mocap.editing import retarget, stance_of
from mocap.errors import SkeletonMismatch
from mocap.feet import clean_up, mark_plants
from mocap.files import load
from mocap.methods.parametric_graphs import cut_actions, cut_strides, make_space
from mocap.methods.parametric_graphs.stride_changes import _pairs, changing_strides
from mocap.methods.parametric_graphs.stride_spaces import measure_mixes
from mocap.methods.parametric_graphs.strides import _example_frames
from mocap.methods.parametric_graphs.tuned import TUNED
from tests.bundled import clips, walks_of_16
from tests.methods.parametric_graphs.built import jogs, punches, slides, strides
from tests.refusals import refusals


def test_phases_0_and_1_are_strikes_of_one_foot():
    """As in [HG07, examples]."""
    cut = strides()
    zero, one = cut.ends
    assert cut.grid[zero] == pytest.approx(0) and cut.grid[one] == pytest.approx(1)
    assert np.abs(cut.seconds[:, zero]).max() == 0
    ends = [-TUNED.margin, 1 + TUNED.margin]
    assert cut.grid[[0, -1]] == pytest.approx(ends, abs=0.02)
    left = cut.contact_names.index("lfoot")
    assert not cut.contacts[:, zero - 3, left].any()  # in the air before it strikes
    assert cut.contacts[:, zero + 3, left].all() and cut.contacts[:, one + 3, left].all()


@pytest.mark.parametrize("feet", ["lrl", "lr", "rl"])
def test_times_rise_and_steps_are_half_of_strides(feet):
    cut = strides(feet)
    assert (np.diff(cut.seconds, axis=1) > 0).all()
    lasts = np.median(cut.seconds[:, cut.ends[1]])
    assert lasts == pytest.approx(1.07 if feet == "lrl" else 0.53, abs=0.1)
    assert len(cut) > 80


def test_an_example_by_itself_is_the_clip():
    """Weight 1 on one example gives back its own way over the ground, to a centimetre of interpolation."""
    cut = strides()
    turn, speed = measure_mixes(cut, np.eye(len(cut))).T
    np.testing.assert_allclose(turn, cut.values[:, 0], atol=np.radians(0.5))
    np.testing.assert_allclose(speed, cut.values[:, 1], rtol=0.01)


def test_it_does_not_matter_where_clips_were_captured():
    (clip,) = clips()[:1]
    here, there = cut_strides([clip]), cut_strides([place(clip, 2.0, [50.0, -7.0])])
    for part in ("seconds", "speeds", "turning", "heights", "values"):
        np.testing.assert_allclose(getattr(here, part), getattr(there, part), atol=1e-6)


def test_a_straight_step_turns_by_nothing_though_the_pelvis_swings():
    left, right = (cut_strides(clips("walk_straight"), feet=feet) for feet in ("lr", "rl"))
    assert np.abs([np.median(some.values[:, 0]) for some in (left, right)]).max() < np.radians(1)
    assert left.sway > np.radians(6) > -np.radians(6) > right.sway  # one swings to the left, the other back
    assert strides().sway == 0


def test_where_the_way_leads_is_told_by_strides_that_go_straight_somewhere():
    """A walk in circles leads aside of where the body faces; steps on the spot lead anywhere."""
    circle = cut_strides([clips()[0][:400]])
    assert np.abs(circle.values[:, 0]).min() > np.radians(20) and circle.offset == 0
    straight = cut_strides(clips()[3:4])
    (walk,) = clips()[3:4]
    roots = walk.root_positions.copy()
    roots[:, [0, 2]] *= -0.02
    spot = replace(walk, root_positions=roots, name="spot")
    assert abs(cut_strides([spot]).offset) == 0
    assert cut_strides([walk, *[spot] * 2]).offset == pytest.approx(straight.offset)


def test_by_curves_examples_are_more_alike_at_one_phase_than_by_strikes():
    gaps = []
    for by in ("strikes", "curves"):
        cut = strides("lrl", by)
        calm = np.flatnonzero(np.abs(cut.values[:, 0]) < np.radians(40))[:30]
        some = np.arange(*cut.ends, 6)
        roots = np.zeros((len(calm) * len(some), 3))
        poses = cut.poses[calm][:, some].reshape(len(roots), -1, 4)
        moved = joint_positions(Motion(cut.skeleton, roots, poses, cut.fps))
        points = moved.reshape(len(calm), len(some), -1)
        apart = np.sqrt(((points[:, None] - points[None]) ** 2).sum(-1) / len(cut.skeleton))
        gaps.append(apart[np.triu_indices(len(calm), 1)].mean())
    assert gaps[1] < gaps[0] < 0.06  # 4.6 and 5.1 cm


def test_feet_that_are_not_marked_are_marked():
    (clip,) = clips()[1:2]
    bare = cut_strides([replace(clip, contacts={})])
    assert len(bare) == pytest.approx(len(cut_strides([clip])), abs=3)


CLIP = clips()[1]

test_what_makes_no_sense_is_refused = refusals(
    ("one clip or more, got none", cut_strides, []),
    ("resample", cut_strides, [sample("walk_curve_1"), CLIP]),
    ("No example of 'll' in 1 clips", lambda: cut_strides([CLIP], feet="ll")),
    ("by 'strikes' or by 'curves', got 'ear'", lambda: cut_strides([CLIP], by="ear")),
    ("No example of 'lrl' labelled 'jog' in 1 clips; 0 were", lambda: cut_strides([CLIP], label="jog")),
    (r"No example of 'lrl' in 1 clips; \d were left out", cut_strides, [CLIP[:40]]),
    ("mark_plants finds out", cut_strides, [replace(CLIP, contacts={"head": np.ones(len(CLIP), bool)})]),
    ("None of", lambda: strides().take(np.zeros(len(strides()), bool))),
)


def test_a_joint_turned_by_half_a_circle_keeps_its_sign_from_phase_to_phase():
    """Files of Bandai-Namco hang the thighs from such a joint; between q and -q a thigh would fly round."""
    half, (walk,) = np.array([0.0, 0, 1, 0]), clips()[:1]
    thigh = walk.skeleton.index("lfemur")
    turned = walk.rotations.copy()
    turned[:, thigh] = multiply(turned[:, thigh], half)
    turned[:, thigh] *= np.where(turned[:, thigh, :1] < 0, -1, 1)  # as a reader of angles has it
    poses = cut_strides([replace(walk, rotations=turned)]).poses
    assert ((turned[1:, thigh] * turned[:-1, thigh]).sum(-1) < 0).any()
    assert ((poses[:, 1:] * poses[:, :-1]).sum(-1) > 0).all()


def test_only_strides_with_a_label_are_cut():
    clip = resample(sample("sneak"), 30)
    sneaks, all_ = cut_strides([clip], label="sneak"), cut_strides([clip])
    assert 3 < len(sneaks) < 0.9 * len(all_)
    assert sneaks.values[:, 1].max() < 0.85 < all_.values[:, 1].max()
    assert len(cut_strides([clip], margin=0.2)) >= len(all_)


def marked_strides(left, right, last=60):
    """Cut strides of 61 frames at 30 Hz by their strikes; frames up to the last one are labelled."""
    clip = resample(sample("walk_straight"), 30)[:61]
    frames = np.arange(61)
    marks = {"lfoot": np.isin(frames, left), "rfoot": np.isin(frames, right)}
    marked = replace(clip, contacts=marks, labels={"walk": frames <= last})
    examples = _example_frames(marked, "lrl", "walk", np.array([-0.5, 0, 0.25, 1, 1.5]))
    return [None if example is None else example.tolist() for example in examples]


def test_margins_without_a_strike_are_as_long_as_the_steps_of_the_stride():
    assert marked_strides([15, 45], [30]) == [[0.0, 15.0, 22.5, 45.0, 60.0]]
    assert marked_strides([3, 14, 40], [27]) == [None, [3.0, 14.0, 20.5, 40.0, 53.0]]  # limping


@pytest.mark.parametrize(("left", "right"), [([0, 14, 44], [29]), ([16, 46], [31])])
def test_margins_outside_the_clip_make_a_stride_unusable(left, right):
    assert marked_strides(left, right) == [None]


def test_a_step_takes_7_to_30_frames():
    """That is 0.23 to 1 s at 30 Hz."""
    assert marked_strides([10, 40], [3, 33, 47]) == [[3.0, 10.0, 21.5, 40.0, 47.0]]
    assert marked_strides([10, 39], [3, 33, 46]) == [None]
    assert marked_strides([10, 47], [3, 17, 54]) == [[3.0, 10.0, 13.5, 47.0, 54.0]]
    assert marked_strides([10, 48], [3, 17, 55]) == [None]


def test_strikes_outside_the_stride_bound_its_margins_if_they_are_a_step_away():
    assert marked_strides([31, 45], [1, 38, 53]) == [[1.0, 31.0, 34.5, 45.0, 53.0]]
    assert marked_strides([32, 46], [1, 39, 53]) == [[25.0, 32.0, 35.5, 46.0, 53.0]]


def test_the_label_lasts_up_to_the_last_strike():
    assert len(marked_strides([10, 47], [3, 17, 54], last=47)) == 1
    assert not marked_strides([10, 47], [3, 17, 54], last=46)


def test_kinds_are_paired_by_similar_turns_or_in_any_way():
    """Without any turn allowed, those more than 5° outside the second kind are left out."""
    first, second = (
        SimpleNamespace(values=np.radians(turns)[:, None]) for turns in ([29, 31, -19, -21, 0], [25, -15])
    )
    similar = _pairs(first, second, any_turn=False)
    assert [rows.tolist() for rows in similar] == [[2, 4, 0], [1, 1, 0]]
    paired = _pairs(first, second, any_turn=True)
    assert [rows.tolist() for rows in paired] == [[3, 2, 4, 0, 1], [1, 0, 1, 0, 1]]


def test_it_starts_as_the_first_kind_and_ends_as_the_second():
    walk, jog = strides(), jogs()
    change = changing_strides(walk, jog)
    zero, one = change.ends
    for kind, phase in ((walk, zero), (jog, one)):
        heights = change.heights[:, phase]
        lowest, highest = (end(kind.heights[:, phase]) for end in (np.min, np.max))
        assert lowest - 1e-9 <= heights.min() <= heights.max() <= highest + 1e-9
    pace = np.abs(change.speeds) / np.gradient(change.seconds, change.grid, axis=1)
    assert pace[:, zero].mean() < 1.5 < 2.0 < pace[:, one].mean()
    np.testing.assert_allclose(np.linalg.norm(change.poses, axis=-1), 1, atol=1e-12)
    assert (np.diff(change.seconds, axis=1) > 0).all() and not change.seconds[:, zero].any()


def test_a_kind_changed_into_itself_is_itself_with_feet_at_rest():
    walk = strides()
    same = changing_strides(walk, walk)
    rows = np.abs(walk.values[:, None] - same.values).max(axis=-1).argmin(axis=0)
    assert len(set(rows)) == len(same) == 60
    np.testing.assert_allclose(same.seconds, walk.seconds[rows], atol=0.01)
    for one, row in enumerate(rows[:5]):
        clock = np.arange(107.0), 60 / same.seconds[one, same.ends[1]]
        moved, own = (k.motion(np.eye(len(k))[n], *clock)[0] for k, n in ((same, one), (walk, row)))
        own = clean_up(replace(own, contacts=moved.contacts))
        np.testing.assert_allclose(own.root_positions[:, 1], same.heights[one], atol=1e-9)


def real(data):
    """Walks, and a boxer's punches on their body."""
    walks = [resample(clip, 30) for clip in walks_of_16(data)]
    boxer = resample(load(data / "cmu/02/02_05.amc", skeleton=data / "cmu/02/02.asf"), 30)
    boxer = retarget(mark_plants(boxer), stance_of(walks[0]), stance_of(boxer))
    middles = (85, 130, 173, 216, 259, 301, 346, 392)
    return cut_strides(walks), cut_actions([boxer] * 8, [(middle - 21, middle + 21) for middle in middles])


@pytest.mark.parametrize(
    ("clips", "most"), [("bundled", 0.4), pytest.param("real", 1.5, marks=pytest.mark.sweep)]
)
def test_planted_feet_hardly_slide_where_walks_are_mixed_and_less_in_changes(clips, most, request):
    walk, punch = real(request.getfixturevalue("real_data")) if clips == "real" else (strides(), punches())
    to, back = changing_strides(walk, punch, stands="second"), changing_strides(punch, walk, stands="first")
    own, *changes = (
        [far for mix in make_space(kind, 0.25, -1, 1).weights[::40] for far in slides(kind.blend(mix))]
        for kind in (walk, to, back)
    )
    assert np.median(own) < most
    assert (
        max(far for kind in (to, back) for mix in np.eye(len(kind)) for far in slides(kind.blend(mix))) < 0.5
    )
    assert all(np.median(mixed) <= 0.3 * np.median(own) and max(mixed) <= max(own) for mixed in changes)


def changed_to(other):
    return changing_strides(strides(), other)


def large():
    return replace(jogs().skeleton, offsets=1.1 * jogs().skeleton.offsets)


test_kinds_that_do_not_fit_are_refused = refusals(
    ("over the same phases", lambda: changed_to(strides("lr"))),
    ("cut strides, not steps", changing_strides, strides("lr"), strides("lr")),
    ("one rate, got 30 and 60 Hz", lambda: changed_to(replace(jogs(), fps=60.0))),
    ("no turn in common", lambda: changed_to(replace(jogs(), values=jogs().values + 9))),
    (SkeletonMismatch, "sits", lambda: changed_to(replace(jogs(), skeleton=large()))),
)
