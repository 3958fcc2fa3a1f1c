"""A teacher's key, and the numbers that it draws.

Each number is a hash (HMAC-SHA256) of the key, the question and the number's name. The same key therefore
draws the same exam in each version of Python, and the numbers of one question tell nothing about another.
"""

from __future__ import annotations

import hashlib
import hmac
import os
import secrets
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from mocap.errors import MocapError

SHORTEST = 20  # characters of a key, so that it cannot be guessed
LONGEST = 10_000  # bytes of a file with a key
NEW_BYTES = 32  # random bytes of a new key
OWNER_ONLY = 0o600
MARK_LENGTH = 8  # characters by which the sheets of a key can be told apart

Choice = TypeVar("Choice")


def read_key(file: Path) -> tuple[bytes, bool]:
    """Read a key, or make a new one that only its owner can read, if there is no such file.

    Returns
    -------
    The key, and whether it is new.

    Raises
    ------
    MocapError : if the file cannot be read or written, or the key is too short or too long.
    """
    try:
        if not file.exists():
            return _new_key(file), True
        with file.open("rb") as opened:
            key = opened.read(LONGEST + 1).strip()
    except OSError as error:
        raise MocapError(f"{file}: {error.strerror or error}.") from error
    if not SHORTEST <= len(key) <= LONGEST:
        count = "more" if len(key) > LONGEST else len(key)
        raise MocapError(f"{file}: a key has {SHORTEST} to {LONGEST} characters, got {count}.")
    return key, False


def _new_key(file: Path) -> bytes:
    """Write a random key to a new file."""
    key = secrets.token_hex(NEW_BYTES).encode()
    descriptor = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, OWNER_ONLY)
    with os.fdopen(descriptor, "wb") as opened:
        opened.write(key + b"\n")
    return key


def mark_of(key: bytes) -> str:
    """Return the mark that the sheets of a key bear, from which the key cannot be found.

    Examples
    --------
    >>> mark_of(b"the key of an example")
    '94c2309b'
    """
    return hmac.digest(key, b"mark", hashlib.sha256).hex()[:MARK_LENGTH]


@dataclass(frozen=True)
class Draws:
    """The numbers that a key draws for a question.

    Attributes
    ----------
    key : the teacher's key.
    question : the number of the question.

    Examples
    --------
    >>> draws = Draws(b"the key of an example", 2)
    >>> draws.integer("thigh", 36, 46), draws.choice("side", ("left", "right"))
    (37, 'right')
    """

    key: bytes
    question: int

    def integer(self, name: str, lowest: int, highest: int, step: int = 1) -> int:
        """Draw an integer; `lowest` and `highest` are included."""
        return self.choice(name, range(lowest, highest + 1, step))

    def choice(self, name: str, options: Sequence[Choice]) -> Choice:
        """Draw one of some options."""
        digest = hmac.digest(self.key, f"{self.question} {name}".encode(), hashlib.sha256)
        return options[int.from_bytes(digest, "big") % len(options)]

    def shuffled(self, name: str, options: Sequence[Choice]) -> list[Choice]:
        """Draw an order of some options."""
        remaining = list(options)
        order = []
        while remaining:
            drawn = self.integer(f"{name} {len(remaining)}", 0, len(remaining) - 1)
            order.append(remaining.pop(drawn))
        return order


@dataclass(frozen=True)
class Question:
    """A question as a key draws it.

    Attributes
    ----------
    values : the texts of its drawn numbers, by their names in `exam.md`.
    results : its answers in numbers, each with its points in parentheses.
    reasons : its answers in words, which the teacher writes, each with its points in parentheses.
    """

    values: dict[str, str]
    results: list[str]
    reasons: list[str]
