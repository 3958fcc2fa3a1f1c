"""The type of the parameter `progress=`."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any

Progress = Callable[[Sequence[Any]], Iterable[Any]]
"""Wraps a sequence and yields its items: `iter` shows no progress, `tqdm.tqdm` shows a progress bar."""
