from .end_bending import bend_to as bend_to
from .in_betweens import InBetween as InBetween
from .in_betweens import fill_gap as fill_gap
from .in_betweens import in_between as in_between
from .interpolation import SHORTEST as SHORTEST
from .interpolation import interpolate as interpolate
