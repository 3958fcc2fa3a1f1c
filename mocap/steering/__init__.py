"""Steering: walks that follow a wish: along a path, through waypoints, to a pose, or in a crowd.

The path objective defines what a walk is asked for and what each deviation costs. A beam search finds the
walk with the lowest cost. `follow_path` joins the two; `waypoints` and `crowd` call it. A new way of steering
that leads to a path gets a file of its own and calls `follow_path`; one that reacts frame by frame fits
the protocol `Character`. A new kind of wish is a field of `Wishes`, with its price in `Prices` and its cost
in `search_states.hop_costs`.

Reading order (notebooks 08, 12, 17, 18)
---------------------------------------
 1. `path_objective`: a path, the wishes along it, and their prices
 2. `search_states`: the walks of a search as arrays: expand, score, prune
 3. `beam_search`: all walks advance along the path together
 4. `followed`: what was found along a path, and how well it follows the path
 5. `path_following`: find a walk along a path
 6. `own_turning`: how walks turn by themselves, and what it costs to turn them further
 7. `bent_following`: any line with any walk: a walk laid on its path
 8. `paper_search`: the same as in 5 by the paper's branch and bound
 9. `waypoints`: places, labels and times to pass
10. `crowd`: many characters that keep apart
11. `moments`: a pose at a place, and the frames of a graph that look like it
12. `two_sided_search`: walks from the start and from the end that meet half-way
13. `end_bending`: a walk bent and stretched so that it ends where it must
14. `pose_fading`: the last differences faded out, and feet that stand
15. `held_ends`: feet that stand, and that are at both ends where the poses put them
16. `in_betweens`: all of it in one function, with what it took
17. `characters`: the protocol, and the pose that a step gives
18. `look_ahead`: the walks ahead of a controlled character, and their cost
19. `graph_control`: a character on a motion graph
20. `foot_turning`: a character that turns about the foot that stands, beyond what its clips turn
21. `steered_motion`: steer a character by a list of headings
22. `obedience`: how soon a character obeys
23. `pursuit`: lead a character to places, and along a path
24. `judged_control`: one protocol for all characters

References
----------
.. [Gle01] M. Gleicher, *Motion Path Editing*, I3D 2001, doi 10.1145/364338.364400.
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "path_objective": ["Prices", "Route", "Wishes", "make_route"],
        "search_states": ["States", "expand", "prune", "score", "start_states"],
        "beam_search": ["Beam", "Found", "find_walk"],
        "followed": ["Departure", "Followed"],
        "path_following": ["follow_path"],
        "own_turning": ["Bending", "OwnTurning", "turning_of"],
        "bent_following": ["BentWalk"],
        "paper_search": ["PathCost", "PathState", "follow_as_2002"],
        "waypoints": ["Arrival", "Waypoint", "WaypointWalk", "through_waypoints"],
        "crowd": ["Crowd", "walk_crowd"],
        "end_bending": ["Limits"],
        "in_betweens": ["InBetween", "Missed", "in_between"],
        "moments": ["Moment"],
        "characters": ["Character", "Pose"],
        "look_ahead": ["Command"],
        "graph_control": ["Controller"],
        "foot_turning": ["FootTurner", "Turnable"],
        "steered_motion": ["Steered", "as_motion", "steer"],
        "obedience": ["Delay", "measure_delay"],
        "pursuit": ["Pursued", "pursue", "walk_to"],
        "judged_control": ["ControlReport", "command_headings", "judge_control"],
    },
)
