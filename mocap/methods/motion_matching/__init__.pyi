from .matching_control import MotionMatcher as MotionMatcher
from .nearest_frames import Wants as Wants
from .pose_database import GROUPS as GROUPS
from .pose_database import features as features
from .pose_database import standardise as standardise
from .pose_database import tabulate as tabulate
