from .ankle_targets import place_plants as place_plants
from .footplants import Footprint as Footprint
from .footplants import find_footprints as find_footprints
from .footplants import mark_plants as mark_plants
from .footplants import runs as runs
from .footplants import standing_tracks as standing_tracks
from .footskate import clean_up as clean_up
