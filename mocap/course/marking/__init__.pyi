from . import grades as grades
from . import walls as walls
from .marks import mark as mark
