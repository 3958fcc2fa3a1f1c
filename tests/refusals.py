"""What a bad call is told."""

from collections.abc import Callable

import pytest

from mocap.errors import MocapError


def refused(
    sentence: str, call: Callable, *given: object, kind: type[BaseException] = MocapError, **options: object
) -> None:
    """Check that a call is refused with this sentence."""
    with pytest.raises(kind, match=sentence):
        call(*given, **options)
