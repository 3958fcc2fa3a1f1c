from . import class_page as class_page
from . import container as container
from . import grades as grades
from . import rosters as rosters
from . import walls as walls
from . import written_points as written_points
from .marks import mark as mark
from .marks import written_answers as written_answers
