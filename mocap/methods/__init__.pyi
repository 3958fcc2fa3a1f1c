from . import groups as groups
from . import in_betweening as in_betweening
from . import match_webs as match_webs
from . import motion_matching as motion_matching
from . import parametric_graphs as parametric_graphs
