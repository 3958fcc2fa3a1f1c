"""Deadlines, at which searches return the best result so far."""

from time import monotonic

from mocap.errors import MocapError

OUT_OF_TIME = "out of time"  # the reason that a search reports if a deadline ended it


class Deadline:
    """A deadline some seconds of wall time after its creation.

    Parameters
    ----------
    seconds : above 0; infinite for no deadline.

    Raises
    ------
    MocapError : for 0 seconds or less, and for nan.

    Examples
    --------
    >>> Deadline(float("inf")).is_over
    False
    >>> Deadline(0)
    Traceback (most recent call last):
    mocap.errors.MocapError: A deadline is more than 0 seconds away, got 0.
    """

    def __init__(self, seconds: float) -> None:
        if not seconds > 0:
            raise MocapError(f"A deadline is more than 0 seconds away, got {seconds:g}.")
        self.end = monotonic() + seconds

    @property
    def is_over(self) -> bool:
        """Whether the deadline has passed."""
        return monotonic() >= self.end

    @classmethod
    def of(cls, limit: "float | Deadline") -> "Deadline":
        """Convert seconds to a deadline. A deadline is returned as it is."""
        return limit if isinstance(limit, Deadline) else cls(limit)
