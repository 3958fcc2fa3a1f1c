from . import grades as grades
from . import rosters as rosters
from . import walls as walls
from .marks import mark as mark
