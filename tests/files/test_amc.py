"""The numbers of Acclaim files, and what is wrong with some of them."""

import numpy as np
import pytest

from mocap.errors import FormatError
from mocap.files import amc
from mocap.files.asf import read_skeleton
from tests.files.acclaim_clips import AMC, read_clip
from tests.refusals import refused


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "thigh 90 0",
            "thigh 90",
            "line 10: expected 2 numbers for 'thigh' .rx rz. after 1 complete frames, got 1",
        ),
        ("thigh 90 0", "thigh 90 0 0", "line 10: expected 2 numbers .*got 3"),
        ("thigh 90 0", "thigh 90 x", "line 10: .*got 'x' as number 2"),
        ("thigh 90 0", "thigh 90 nan", "line 10: .*got 'nan' as number 2"),
        ("thigh 90 0", "knee 90 0", "line 10: expected another bone of the skeleton, got 'knee'"),
        ("thigh 90 0", "arm 90 0", "line 11: expected another bone of the skeleton, got 'arm'"),
        ("thigh 90 0", "hip 1", "line 10: expected 0 numbers for 'hip'"),
        ("arm 90 90\n", "", "line 10: expected numbers for arm, got the end of the frame after 1 complete"),
        ("arm 90 90\n", "arm 9", "line 11: expected 2 numbers for 'arm' .*after 1 complete frames, got 1"),
        ("\n2\n", "\n3\n", "line 8: expected frame 2, got frame 3"),
        ("\n1\n", "\n", "line 4: expected the number of the first frame, got 'root"),
        ("\n1\n", "\n<<<<<<< HEAD\n1\n", "line 4: .*unresolved merge"),
        ("arm 90 90", "=======", "line 11: .*'======='"),
    ],
)
def test_a_broken_amc_is_refused_at_its_line(write, old, new, message):
    assert old in AMC
    refused(message, read_clip, write, amc_text=AMC.replace(old, new), kind=FormatError)


@pytest.mark.parametrize("text", [":DEGREES\n", "# only this\n"])
def test_an_empty_clip_is_refused(write, text):
    refused("expected frames, got none", read_clip, write, amc_text=text, kind=FormatError)


def test_columns_and_lines_read_the_same(real_data):
    text = (real_data / "cmu/16/16_35.amc").read_text()
    asf = read_skeleton(real_data / "cmu/16/16.asf")
    _, start, counts = amc._opening(text)
    fast = amc._read_columns(text.split("\n", start)[-1], counts)
    slow = amc._read_lines("16_35.amc", text, asf.dofs(), asf.needed())
    assert fast is not None
    assert fast.keys() == slow.keys()
    assert all(np.array_equal(fast[name], slow[name]) for name in slow)


def test_a_comment_may_tell_the_rate(write):
    assert read_clip(write, amc_text=f"# fps 29.97\n{AMC}").fps == 29.97
    assert read_clip(write, amc_text=f"# fps 29.97\n{AMC}", fps=60.0).fps == 60.0
    assert read_clip(write, amc_text=f"# fps are many\n{AMC}", fps=60.0).fps == 60.0
    for wrong in ("0", "-1", "nan"):
        with pytest.raises(FormatError, match="line 1: expected frames per second, above 0"):
            read_clip(write, amc_text=f"# fps {wrong}\n{AMC}")
