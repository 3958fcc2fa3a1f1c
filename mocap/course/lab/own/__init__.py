"""A motion graph made of the functions that students write in notebooks 01 to 08, from clips to a walk.

Nothing here is quick, and each step is one that the course explains. All that an exercise asks for is called
by way of `tools`: the student's function where it passed its check, else the package's. So the walk at the
end is the student's own as far as they have come. How the package goes from clips to a walk, more quickly and
with more wishes, is in `matching`, `graphs`, `synthesis` and `steering`.

Reading order
-------------
1. `building`: the functions that the exercises ask for, and a graph of clips by them
2. `walking`: walks along a path or by commands, and their motions
3. `beside`: one's own walk beside the package's

References
----------
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "building": ["build_own", "tools"],
        "walking": ["follow_own", "play_own", "steer_own"],
        "beside": ["walk_beside"],
    },
)
