"""Sorting with a tolerance, in part, agrees with sorting all."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from mocap._shared.ties import first_in_order, in_order

EQUAL = 0.1
values = st.lists(st.integers(0, 60).map(lambda number: number / 16), min_size=1, max_size=40)


@given(values, st.integers(1, 45))
def test_the_first_in_order_are_those_of_all_in_order(numbers, count):
    """Sixteenths are exact, and neighbours among them are equal within a tenth: chains of ties occur."""
    np.testing.assert_array_equal(
        first_in_order(numbers, EQUAL, count), in_order(numbers, EQUAL)[:count], strict=True
    )
