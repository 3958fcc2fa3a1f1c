"""Answers go to the marker unchanged, and nothing else does."""

import collections
import json

import hypothesis.extra.numpy as arrays
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap.body import PlanarTransform
from mocap.course.marking.plain_data import pack, unpack

NUMBERS = st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text()
KEYS = NUMBERS | st.complex_numbers(allow_nan=False)


def sent(value):
    return unpack(json.loads(json.dumps(pack(value))))


@given(
    st.recursive(
        KEYS,
        lambda inner: (
            st.lists(inner) | st.tuples(inner, inner) | st.sets(KEYS) | st.dictionaries(KEYS, inner)
        ),
        max_leaves=20,
    )
)
def test_plain_data_arrive_as_they_are(value):
    assert sent(value) == value


@given(arrays.arrays(arrays.scalar_dtypes().filter(lambda t: t.kind in "biufc"), arrays.array_shapes()))
def test_arrays_arrive_with_type_and_shape(array):
    arrived = sent(array)
    assert arrived.dtype == array.dtype
    np.testing.assert_array_equal(arrived, array)


def test_what_is_nearly_plain_becomes_plain():
    assert sent([np.float64(1.5), np.int32(2), np.bool_(True), np.str_("a"), ...]) == [1.5, 2, True, "a", ...]
    assert sent({1: 2}.keys()) == {1}
    assert sent(collections.Counter("a")) == {"a": 1}
    assert sent(PlanarTransform(1.0, 2.0, 3.0)) == (1.0, 2.0, 3.0)
    assert sent(range(2)) == sent(collections.deque([0, 1])) == [0, 1]
    assert sent(np.array([1, "a"], object)) == [1, "a"]


def test_of_anything_else_only_the_type_arrives():
    assert sent([object(), lambda: 1]) == ["<object>", "<function>"]


@pytest.mark.parametrize(
    "packed",
    [
        ["eval", "1"],
        [],
        ["array", "|O8", [1], "AAAAAAAAAAA="],
        ["array", "<f8,<f8", [1], ""],
        ["array", "<f8", [10**12], "AAAAAAAAAAA="],
        ["array", "<f8", [-5, -5], ""],
        ["set", [["list", []]]],
        ["dict", [[1]]],
        [["list", []], []],
    ],
)
def test_what_pack_cannot_have_given_is_refused(packed):
    with pytest.raises((ValueError, KeyError, TypeError)):
        unpack(packed)
