"""Out of the graph: walks at random or by search, and the motions they stand for.

A walk is a list of edges, each starting where the one before ends; `to_motion` plays it.

Reading order (notebook 07)
---------------------------
1. `walks`: a walk, its seams and its sources
2. `random_walks`: wander through a graph
3. `walk_to_motion`: play a walk
4. `bounded_search`: the paper's search: branch and bound
5. `streaming`: hours of walk, piece by piece

References
----------
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "walks": ["Seam", "require_walk", "seams", "sources"],
        "random_walks": ["random_walk", "wander"],
        "walk_to_motion": ["places", "to_motion", "with_plants"],
        "bounded_search": [
            "Branch",
            "Budget",
            "Problem",
            "SearchResult",
            "branch_and_bound",
            "children",
            "search_ahead",
        ],
        "streaming": ["dump", "stream"],
    },
)
