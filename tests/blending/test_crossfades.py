"""From clip into clip: its ends are the clips, its middle skates less than a long join."""

import numpy as np
import pytest

from mocap._shared.arrays import runs
from mocap.blending.mixing import crossfade
from mocap.blending.registering import register
from tests.blending.registered import at_times, slides, walks, way
from tests.blending.test_mixing import largest_gap
from tests.refusals import refused

PAIRS = [((0.8, 0), (1.4, 0)), ((1.1, -120), (1.1, 120))]


@pytest.fixture(scope="module", params=PAIRS, ids=["faster", "the other way"])
def registration(request):
    return register([walks()[which] for which in request.param])


def test_it_starts_as_the_one_and_ends_as_the_other(registration):
    """As in [KG03, transition]."""
    made = crossfade(registration)
    first, second = registration.clips
    assert largest_gap(made[:60], first[:60]) < 1e-9
    late = float(registration.times[1].inverse(second.duration))
    assert late > registration.span[1]
    ends = [
        largest_gap(made[-60:], at_times(second, second.duration - shift - np.arange(60)[::-1] / 120))
        for shift in np.linspace(0, 1 / 120, 40)
    ]
    assert min(ends) < 1e-3
    assert made.duration < first.duration + second.duration and made.name == "walk to walk"


def test_the_longer_the_fade_the_less_its_plants_slide(registration):
    strays = [slides(crossfade(registration, seconds=seconds)).max() for seconds in (0.33, 1.0, 2.0)]
    assert strays == sorted(strays, reverse=True)
    assert strays[2] <= 2.5


def test_the_reference_is_left_and_the_other_entered():
    slow, brisk = walks()[0.8, 0], walks()[1.4, 0]
    slowing = crossfade(register([slow, brisk], reference=1))
    speeds = [way(part) / part.duration for part in (slowing[:60], slowing[-60:])]
    assert speeds[0] > 1.2 and speeds[1] < 0.95


def test_plants_are_those_of_the_clips_and_of_both(registration):
    made = crossfade(registration)
    first, second = registration.clips
    assert set(made.contacts) == set(first.contacts)
    for joint in made.contacts:
        before = int(120 * (sum(registration.span) / 2 - 0.5))
        assert np.array_equal(made.contacts[joint][:before], first.contacts[joint][:before])
        count = len(runs(made.contacts[joint]))
        assert count <= len(runs(first.contacts[joint])) + len(runs(second.contacts[joint]))


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"seconds": 0}, "longer than 0 s, got 0"),
        ({"seconds": np.nan}, "longer than 0 s, got nan"),
        ({"seconds": 99.0}, "does not lie within"),
        ({"at": 0.1}, r"A fade from -0.40 to 0.60 s does not lie within the \d.\d\d to \d.\d\d s"),
        ({"at": np.nan}, "does not lie within"),
    ],
)
def test_what_is_no_fade_is_refused(registration, settings, message):
    refused(message, crossfade, registration, **settings)
