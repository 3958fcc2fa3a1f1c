"""The sheets of edits show both states of a clip from three directions, and its footplants."""

import edits_looked_at as sheets
import pytest


def test_a_sheet_shows_a_clip_before_and_after_an_edit():
    (pair,) = sheets.pairs_of(["walk_straight:mirror"], seconds=1)
    figure = sheets.sheet(pair)
    panels = [ax for ax in figure.axes if len(ax.collections) == sheets.MOMENTS]
    assert [ax.get_title(loc="left") for ax in panels] == [
        f"{view}, {state}" for view in ("side", "front", "above") for state in ("before", "after")
    ]
    assert "mirror; score 0.00, then 0.00" in figure.get_suptitle()


def test_a_knee_is_drawn_around_the_frame_in_which_its_ankle_leaves_the_ground():
    clip = sheets.load_clip("walk_straight", seconds=2)
    frame, leg = sheets.hand_over(clip)
    ankle, ball = (clip.contacts[clip.skeleton.names[joint]] for joint in leg[2:])
    assert ankle[frame - 1] and not ankle[frame] and ball[frame - 1 : frame + 1].all()
    with pytest.raises(sheets.MocapError, match="No footplant of 'walk_straight' passes"):
        sheets.hand_over(clip[:40])


def test_the_body_is_seen_from_its_hips():
    clip = sheets.load_clip("walk_circle", seconds=1)
    seen = sheets.seen_from_hips(clip)
    left, right = (leg.hip for leg in sheets.find_legs(clip.skeleton))
    assert (seen[:, left, 0] > 0).all() and (seen[:, right, 0] < 0).all()
    assert abs(seen[:, [left, right], 2]).max() < 1e-9
