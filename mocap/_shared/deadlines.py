"""A deadline: the moment at which a search ends with the best that it has."""

from time import monotonic

from mocap.errors import MocapError

OUT_OF_TIME = "out of time"  # what a search says that a deadline ended


class Deadline:
    """A moment some seconds of wall time after the deadline was made.

    Parameters
    ----------
    seconds : above 0; infinite for none.

    Raises
    ------
    MocapError : for 0 seconds or less, and nan.

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
        """Whether the moment is now or was earlier."""
        return monotonic() >= self.end

    @classmethod
    def of(cls, limit: "float | Deadline") -> "Deadline":
        """Return a deadline as it is, and make one of seconds."""
        return limit if isinstance(limit, Deadline) else cls(limit)
