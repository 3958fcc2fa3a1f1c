"""What a bad call is told, and what is told without being asked."""

import warnings
from collections.abc import Callable
from pathlib import Path

import pytest

from mocap.errors import MocapError, MocapWarning
from tests.loops import for_each


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


def refusals(*rows: tuple) -> Callable:
    """Make one test of rows (sentence, call, what is given), before which the kind of error may stand."""

    @for_each(rows)
    def test(row: tuple) -> None:
        kind, *rest = row if isinstance(row[0], type) else (MocapError, *row)
        refused(*rest, kind=kind)

    return test


def refused_texts(read: Callable, name: str, *rows: tuple, kind: type[MocapError] = MocapError) -> Callable:
    """Make one test of rows (a file's text or bytes, sentence): no file of that name can be read."""

    def test(tmp_path: Path) -> None:
        for text, sentence in rows:
            (tmp_path / name).write_bytes(text if isinstance(text, bytes) else text.encode())
            refused(sentence, read, tmp_path / name, kind=kind)

    return test


def quietly(call: Callable, *given: object, **options: object) -> object:
    """Call without the package's warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MocapWarning)
        return call(*given, **options)


def told(sentence: str, call: Callable, *given: object, most: float = 200, **options: object) -> object:
    """Check that a call warns with this sentence, and with none of more than `most` characters."""
    with pytest.warns(MocapWarning, match=sentence) as caught:
        result = call(*given, **options)
    assert all(len(str(warning.message)) <= most for warning in caught)
    return result


def unwarned(call: Callable, *given: object, **options: object) -> object:
    """Call where nothing may be warned of."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return call(*given, **options)
