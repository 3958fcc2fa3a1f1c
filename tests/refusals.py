"""What a bad call is told."""

from collections.abc import Callable

import pytest

from mocap.errors import MocapError


def refused(
    sentence: str,
    call: Callable,
    *given: object,
    kind: type[BaseException] = MocapError,
    most: float = 200,
    **options: object,
) -> None:
    """Check that a call is refused with this sentence, in `most` characters without the path."""
    with pytest.raises(kind, match=sentence) as told:
        call(*given, **options)
    assert len(str(told.value)) - len(str(getattr(told.value, "path", ""))) <= most
