"""A walk where one wants it: along a path, through waypoints, in a crowd, or by hand.

The path objective says what a walk is to keep to and what it costs to miss it; a beam search finds the best
walk; the other files ask for it in different ways.

Reading order (notebook 08)
---------------------------
1. `path_objective`: what is wished for along a path, and what it costs to go without
2. `search_states`: walks under way as arrays: expand, score, prune
3. `beam_search`: all walks advance together
4. `path_following`: a walk along a path, and how well it keeps to it
5. `paper_search`: the same by the search of 2002
6. `waypoints`: what kind of motion, where, and when
7. `crowd`: many characters, kept apart
8. `control`: a character that is told where to go while it walks

References
----------
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "path_objective": ["Prices", "Route", "Wishes", "make_route"],
        "search_states": ["States", "expand", "prune", "score", "start_states"],
        "beam_search": ["Beam", "Found", "find_walk"],
        "path_following": ["Departure", "Followed", "follow_path"],
        "paper_search": ["PathCost", "PathState", "follow_as_2002"],
        "waypoints": ["Arrival", "Waypoint", "WaypointWalk", "through_waypoints"],
        "crowd": ["Crowd", "walk_crowd"],
        "control": ["Command", "Controller", "Delay", "Pose", "measure_delay"],
    },
)
