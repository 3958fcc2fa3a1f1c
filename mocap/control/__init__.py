"""Control: characters that get a new command in any frame, and how soon they obey.

All fit one protocol, `Character`: its `step` takes a heading and a speed and gives the next pose. So whatever
steers, records or measures one of them does so for all. A new way of control is a class with the same
members, in a file of its own.

Reading order (notebooks 08, 12, 17, 18)
----------------------------------------
1. `characters`: the protocol, and the pose that a step gives
2. `look_ahead`: the walks ahead of a controlled character, and their cost
3. `graph_control`: a character on a motion graph
4. `foot_turning`: a character that turns about the foot that stands, beyond what its clips turn
5. `steered_motion`: steer a character by a list of headings
6. `obedience`: how soon a character obeys
7. `pursuit`: lead a character to places, and along a path
8. `judged_control`: one protocol for all characters

References
----------
.. [Gle01] M. Gleicher, *Motion Path Editing*, I3D 2001, doi 10.1145/364338.364400.
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
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
