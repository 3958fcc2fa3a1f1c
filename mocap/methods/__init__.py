"""Methods of their own kind, each a room: what other papers made of captured motion.

Reading order (notebooks 16 to 19)
----------------------------------
1. `match_webs`: all motions like an example, and spaces of blends between them (16)
2. `parametric_graphs`: graphs of whole spaces of strides, and characters that need no search (17)
3. `motion_matching`: characters without a graph: the frame that fits best, searched again and again (18)
4. `groups`: a crowd that was planned: group graphs, and characters for their members (19)
5. `in_betweening`: from one pose to another in a given time
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)
