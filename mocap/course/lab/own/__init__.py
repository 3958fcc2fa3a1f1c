"""A motion graph made of the functions that students write in notebooks 01 to 08, from clips to a walk.

Nothing here is quick, and each step is one that the course explains. All that an exercise asks for is called
by way of `Tools`: the student's function where it passed its check, else the package's. So the walk at the
end is the student's own as far as they have come. How the package goes from clips to a walk, more quickly and
with more wishes, is in `matching`, `graphs`, `synthesis` and `steering`.

Reading order
-------------
1. `tools`: the functions that the exercises ask for
2. `clouds`: where the joints are, by climbing
3. `matches`: distance grids, their minima, and the transitions there
4. `pieces`: nodes and edges, and the component to keep
5. `by_hand`: stand-ins for two of the functions, made of others
6. `searching`: a walk along a path, layer by layer
7. `playing`: a walk as a motion
8. `steering_by_hand`: a walk that takes one command after the other
9. `beside`: one's own walk beside the package's
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "tools": ["NAMES", "Tools", "packages", "replaced", "tools"],
        "clouds": ["joint_cloud"],
        "matches": ["Match", "find_matches", "window_distances"],
        "pieces": ["OwnEdge", "OwnGraph", "build_own"],
        "searching": ["OwnWalk", "follow_own"],
        "playing": ["play_own"],
        "steering_by_hand": ["steer_own"],
        "beside": ["Beside", "walk_beside"],
    },
)
