"""The garbage collector pauses, and is afterwards as it was before."""

import gc

import pytest

from mocap._shared.collector import uncollected


@pytest.mark.parametrize("switch", [gc.disable, gc.enable])
def test_the_collector_pauses_and_is_left_as_it_was(switch):
    switch()
    before = gc.isenabled()
    try:
        with pytest.raises(ZeroDivisionError), uncollected():
            assert not gc.isenabled()
            raise ZeroDivisionError
        assert gc.isenabled() == before
    finally:
        gc.enable()
