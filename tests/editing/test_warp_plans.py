"""A plan says which joints are moved when, and which moments happen when; what makes no sense is refused."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.body import joint_positions
from mocap.datasets.samples import sample
from mocap.editing.warp_plans import load_plan, warp
from mocap.errors import FormatError, MocapError
from tests.editing.test_path_editing import slide
from tests.refusals import refused_texts

WALK = sample("walk_straight")[:361]  # 3 s
HAND = WALK.skeleton.index("lhand")


@pytest.fixture
def plan(tmp_path):
    """Return a function that writes a plan for a motion, and reads it."""

    def write(text, motion=WALK):
        (tmp_path / "keys.txt").write_text(text)
        return load_plan(tmp_path / "keys.txt", motion)

    return write


def test_the_move_is_by_the_bodys_own_directions(plan):
    turned = sample("walk_circle")[1200:1500]
    key = plan("at 150 lhand 0.10 0.2 0.05", turned)
    moved = joint_positions(warp(turned, key))[150, HAND] - joint_positions(turned)[150, HAND]
    assert np.linalg.norm(moved) == pytest.approx(np.linalg.norm([0.1, 0.2, 0.05]), abs=1e-5)
    assert moved[1] == pytest.approx(0.2, abs=1e-5)
    assert np.abs(moved - [0.1, 0.2, 0.05]).max() > 0.02


def test_the_motion_is_as_it_was_outside_the_window_unless_the_plan_says_from_when(plan):
    at = joint_positions(WALK)[:, HAND]

    def changed(text, window=0.5):
        warped = warp(WALK, plan(text), window=window, feet=False)
        return np.flatnonzero(np.linalg.norm(joint_positions(warped)[:, HAND] - at, axis=-1) > 1e-9)

    plain = changed("at 1.5s lhand 0 0.1 0")
    assert plain[[0, -1]].tolist() == [121, 239]
    assert changed("at 1.5s lhand 0 0.1 0", 1.0)[[0, -1]].tolist() == [61, 299]
    assert changed("at 1.5s lhand 0 0.1 0\nat 170 same\nat 190 level")[[0, -1]].tolist() == [171, 189]
    assert changed("at 0.1s lhand 0 0.1 0")[[0, -1]].tolist() == [0, 71]
    assert len(changed("at 90 same\nat 100 same")) == 0


def test_a_hand_at_its_place_leaves_the_feet_at_theirs(plan):
    warped = warp(WALK, plan("at 1.5s lhand 0.1 0.3 0.1\nat 2s root 0 -0.1 0"))
    assert slide(warped) < 1e-3
    hand = joint_positions(warped)[180, HAND] - joint_positions(WALK)[180, HAND]
    assert np.linalg.norm(hand) == pytest.approx(np.linalg.norm([0.1, 0.3, 0.1]), abs=1e-5)


def test_between_two_level_poses_the_hand_stays(plan):
    wide, level = (
        joint_positions(warp(WALK, plan(f"at 1s lhand 0 0.3 0{end}\nat 2s lhand 0 0.3 0{end}"), feet=False))
        for end in ("", " level")
    )
    rise = [(at[120:241, HAND] - joint_positions(WALK)[120:241, HAND])[:, 1] for at in (wide, level)]
    assert rise[1] == pytest.approx(0.3, abs=0.06)
    assert np.ptp(rise[1]) < np.ptp(rise[0])


test_a_file_of_another_form_names_the_line = refused_texts(
    lambda file: load_plan(file, WALK),
    "keys.txt",
    ("", "expected some text, got an empty file"),
    ("# nothing", "or 'time NEW OLD', got no key"),
    ("at 5 same\nmove lhand", "line 2: expected 'at MOMENT JOINT LEFT UP AHEAD .*got 'move lhand'"),
    ("at 5", "line 1: expected 'at MOMENT .*got 'at 5'"),
    ("at 5 lhand", "line 1: .*got 'at 5 lhand'"),
    ("at 5 same 1 2 3", "line 1: .*got 'at 5 same 1 2 3'"),
    ("at 5 lhand 1 2 level", "line 1: expected LEFT UP AHEAD.*got 'level' as number 3"),
    ("at", "line 1: .*got 'at'"),
    ("at -5 same", "line 1: .*got 'at -5 same'"),
    (f"at {'9' * 400} same", "line 1: expected a moment, all below 1e[+]09"),
    ("\n\nat 5 lhand 1 nan 3", "line 3: expected LEFT UP AHEAD, in metres.*got 'nan' as number 2"),
    ("time 1 x", "line 1: expected time NEW OLD, in seconds, got 'x' as number 2"),
    ("time 0 0", "line 1: expected two lines or more about time, got one"),
    ("time 0 0\n\ntime 2 2\ntime 3 2", "line 4: expected two seconds after 2 and 2, .* line 3, got 3 and 2"),
    ("time 0 0\ntime 2 1\ntime 2 3", "line 3: expected two seconds after 2 and 1, .* line 2, got 2 and 3"),
    ("\0", "a zero byte"),
    kind=FormatError,
)
test_a_plan_that_the_clip_cannot_follow = refused_texts(
    lambda file: warp(WALK, load_plan(file, WALK)),
    "keys.txt",
    ("at 361 same", r"line 1: expected a moment up to frame 360, or second 3, got frame 361"),
    ("at 5s same", "got frame 600"),
    ("at 5 hand 0 0 0", r"line 1: expected a joint, such as rhand, lhand, .*got 'hand'"),
    ("at 1s lhand 0 0 0\nat 120 level", "expected one target for a joint at frame 120, got 'level' beside"),
    ("at 1s lhand 0 0 0\nat 120 lhand 0 1 0", "line 2: .*'lhand' beside 'lhand' of line 1"),
    ("at 1s lhand 0 9 0", r"keys.txt, line 1: Frame 120: '\w+' would be .* m from"),
    ("time 0 0\ntime 1 3.005", "line 2: expected an old second up to 3, the clip's last, got 3.005"),
    ("time 0 -1\ntime 1 2", "line 1: expected an old second up to 3, the clip's last, got -1"),
    ("time 0 0\ntime 1e8 2", r"ask for 1.2e\+10 frames"),
)


words = st.sampled_from(
    ["at", "time", "same", "level", "lhand", "1s", "7", "0.1", "-1", "nan", "é", "#", "9" * 99]
)


@given(st.lists(st.lists(words, max_size=7).map(" ".join), max_size=4).map("\n".join))
def test_any_words_are_a_plan_or_one_sentence(tmp_path_factory, text):
    path = tmp_path_factory.getbasetemp() / "any.txt"
    path.write_text(text, encoding="utf-8")
    try:
        warp(WALK[:40], load_plan(path, WALK[:40]), feet=False)
    except MocapError as error:
        assert "\n" not in str(error)
        assert len(str(error)) <= 200 + len(str(path))
