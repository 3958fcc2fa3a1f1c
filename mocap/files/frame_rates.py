"""Frame rates from frame times that were written with few digits, and from single-precision numbers.

A file that says 0.033 s a frame was recorded at 30 Hz, and not at 30.30 Hz: exporters round or truncate the
frame time. Of the rates whose frame times have the same digits, a usual one is the most likely.
"""

from decimal import Decimal

USUAL = (24.0, 25.0, 30.0, 48.0, 50.0, 60.0, 72.0, 90.0, 100.0, 120.0, 144.0, 150.0, 200.0, 240.0, 250.0)
"""Frame rates of cameras, games and capture systems, Hz."""

TRUNCATED = 0.999  # of a last digit: by truncation a number loses less than one
EXACT = 1e-12  # seconds: rounding of a frame time that is written with all digits of a double
SIMILAR = 0.12  # relative: a frame time of two digits, such as 0.03 for 30 Hz, is no further off
SINGLE = 1e-6  # relative: a rate that went through a number of single precision


def rate_of(digits: str) -> tuple[float, bool]:
    """Return the frame rate in Hz that a frame time in seconds stands for, and whether it is certain.

    A whole rate whose frame time has these digits replaces the quotient: a usual rate if there is one, else
    the nearest whole number. It is certain unless a whole number is nearer than the usual rate. Zeros at the
    end count as digits unless no whole rate has them all.

    Parameters
    ----------
    digits : the frame time as it is written, above 0.

    Examples
    --------
    >>> rate_of("0.0333333"), rate_of("0.033"), rate_of("0.008")
    ((30.0, True), (30.0, True), (120.0, False))
    >>> rate_of("0.03333300")  # single precision, written with eight digits
    (30.0, True)
    """
    seconds = float(digits)
    nearest = max(1.0, float(round(1 / seconds)))
    usual = min(USUAL, key=lambda rate: abs(1 / rate - seconds))
    for last_digit in (_last_digit(Decimal(digits)), _last_digit(Decimal(digits).normalize())):
        tolerance = max(TRUNCATED * last_digit, EXACT)
        if abs(1 / usual - seconds) < min(tolerance, SIMILAR * seconds):
            return usual, usual == nearest
        if abs(1 / nearest - seconds) < tolerance:
            return nearest, True
    return 1 / seconds, True


def without_noise(rate: float) -> float:
    """Return a rate that lost digits to single precision as the whole number that it was.

    Examples
    --------
    >>> without_noise(120.00004577636719), without_noise(29.97)
    (120.0, 29.97)
    """
    whole = float(round(rate))
    return whole if abs(rate - whole) < SINGLE * rate else rate


def _last_digit(number: Decimal) -> float:
    """Return the value of a one in the last digit of a number, at most 1."""
    return 10.0 ** min(0, int(number.as_tuple().exponent))
