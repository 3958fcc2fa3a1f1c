"""The transition inspector: two windows to point at, their turn, their weights and their seam.

Its scripts run in the page and need no Python. What they compute are formulas of the package, for which the
tests compare them with the package's functions: the point cloud's best turn and distance [KGP02, Eqs. 1-4],
the blend [KGP02, Eqs. 5-7] and the jolts of its result. That one page shows them all, on one clock, is ours.

Reading order
-------------
1. `packing`: clips as small blocks of bytes
2. `choices`: which two windows are looked at, and what lies around them
3. `scenes`: all that a page needs
4. `showing`: the widget, its picture and its sentence

References
----------
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={"showing": ["Inspector", "inspector"]},
)
