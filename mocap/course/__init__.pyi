from . import checks as checks
from . import diagrams as diagrams
from . import lab as lab
from .real_clips import collections as collections
from .real_clips import people as people
