"""Further methods of motion synthesis from other papers, each in its own room.

Reading order (notebooks 16 to 19)
----------------------------------
1. `match_webs`: all motions similar to an example, and parameterised spaces of their blends (16)
2. `parametric_graphs`: graphs whose nodes are spaces of motions, and characters that need no search (17)
3. `motion_matching`: characters without a graph, which repeatedly search the best frame of all clips (18)
4. `groups`: planned motion of a crowd: group graphs, and characters for the members (19)
5. `in_betweening`: motion from one pose to another in a given time
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)
