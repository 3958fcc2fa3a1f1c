from .distance_grids import distance_grid as distance_grid
from .minima import local_minima as local_minima
from .point_clouds import align as align
from .point_clouds import distinct_joints as distinct_joints
from .point_clouds import point_cloud as point_cloud
from .time_paths import time_path as time_path
from .transitions import Transition as Transition
from .transitions import find_transitions as find_transitions
