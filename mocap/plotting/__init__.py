"""Pictures, by matplotlib: stick figures, distance images, paths, curves and graphs.

Every function draws on `ax` (new axes by default), computes nothing of its own, and returns the artists that
it made; `show` puts the picture into a notebook with a sentence for readers who do not see it.

Reading order (notebooks 00 to 19)
----------------------------------
 1. `style`: colours that colour-blind readers can tell apart
 2. `axes`: 3D axes with a ground
 3. `stick_figures`: bodies as lines
 4. `bodies_on_path`: a whole walk in one picture
 5. `charts`: distance images, paths from above, curves
 6. `graph_drawing`: motion graphs as timelines and as nodes with arrows
 7. `search_tree`: the walks that a search expands and cuts off
 8. `spread_charts`: medians with quartiles, and random walks as rows
 9. `storyboards`: a transition in four panels
10. `picture`: a figure as a picture in a notebook
11. `registration_charts`: a grid with its time path, plants as bars, tracks over the ground
12. `web_charts`: paths over a grid, matches step by step, samples of a space and a wish
13. `group_plans`: where the members of a group go, seen from above
14. `box_charts`: what may follow one source, and the boxes of all sources

References
----------
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "style": [
            "ASKED",
            "ASTRAY",
            "COLOURS",
            "CURVES",
            "FLOOR",
            "MARK",
            "PATH",
            "QUIET",
            "SOURCES",
            "source_colours",
        ],
        "axes": ["ground_axes", "to_picture"],
        "stick_figures": [
            "Bones",
            "StickFigure",
            "bones",
            "film_strip",
            "flat_bodies",
            "laid_over",
            "stick_figure",
        ],
        "bodies_on_path": ["bodies_along"],
        "charts": ["asked_and_walked", "distance_image", "footprints", "joint_curve", "path_from_above"],
        "graph_drawing": ["before_and_after", "node_link", "timeline"],
        "search_tree": ["SearchTree", "TreePicture", "grow_tree"],
        "spread_charts": ["Band", "quartile_band", "seen_beside_measured", "walk_rows"],
        "storyboards": ["Shot", "storyboard"],
        "picture": ["Picture", "show", "stack"],
        "box_charts": ["box_chart", "boxes_image"],
        "group_plans": ["draw_group_plan"],
        "web_charts": ["match_tree", "space_image", "target_poses", "web_image"],
        "registration_charts": ["WarpPicture", "ground_tracks", "plant_bars", "warp_image"],
    },
)
