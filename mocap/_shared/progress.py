"""The type of the parameter `progress=`."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any

Progress = Callable[[Sequence[Any]], Iterable[Any]]
"""Wraps a sequence and yields its items one by one: `iter` shows nothing, `tqdm.tqdm` shows a bar."""
