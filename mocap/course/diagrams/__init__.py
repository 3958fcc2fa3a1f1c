"""Diagrams: an idea drawn before its formula, step by step.

Each function draws one idea and returns a figure. Where the idea has steps, the parameter `step` says how
many of them are drawn, so that an experiment can show them one after the other. A new diagram is a function
in the file of its subject.

Reading order (notebooks 00 to 09)
----------------------------------
 1. `small_graphs`: a motion graph's nodes and edges on two clips, and the homework's segments in rows
 2. `quaternions`: two half turns, and turns whose order matters; `trees`: forward kinematics by joint
 3. `windows`: what a window is, a lower bound of the distance of two, and sums along diagonals
 4. `laying_clouds`: one cloud of points laid on another, from above
 5. `ground`: headings, and one clip aligned with another, seen from above
 6. `seams`: frames of a transition, ways between two rotations, a leg as a triangle, and added jolts
 7. `eight_nodes`: Tarjan's search with its low links, and the walks that branch and bound takes up
 8. `layers`: the layered search along a line, with the line of its code that runs
 9. `distances_to_paths`: how far a walk is from its path, at equal arc length and to the nearest point
10. `pens`: arrows, words, discs and steps that several of them share

References
----------
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "small_graphs": ["nodes_and_edges", "segments_in_rows"],
        "quaternions": ["half_turns", "turns_in_order"],
        "trees": ["down_the_tree"],
        "laying_clouds": ["laid", "laying_on", "products", "turning"],
        "windows": ["diagonal_sums", "radius_gaps", "window_cloud"],
        "ground": ["alignment", "compass", "two_ways_round"],
        "seams": ["added_by_blend", "blended_seam", "knee_triangle", "turning_paths"],
        "eight_nodes": [
            "EIGHT_PLACES",
            "edge_lengths",
            "eight_node_graph",
            "search_events",
            "search_steps",
            "tarjan_states",
            "tarjan_step",
        ],
        "layers": ["layer_states", "layer_step"],
        "distances_to_paths": ["two_distances"],
    },
)
