"""The quintic step starts and ends at rest."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mocap._shared.easing import quintic_step


def test_the_step_starts_and_ends_at_rest_and_unaccelerated():
    for end in (0.0, 1.0):
        near = quintic_step(end + np.array([-2e-4, -1e-4, 0, 1e-4, 2e-4]))
        assert np.diff(near) == pytest.approx(0, abs=1e-10)
        assert np.diff(near, 2) / 1e-8 == pytest.approx(0, abs=0.02)


@given(st.floats(-1, 2))
def test_the_step_is_its_own_mirror_image(amount):
    assert quintic_step(amount) + quintic_step(1 - amount) == pytest.approx(1)
    assert 0 <= quintic_step(amount) <= 1
