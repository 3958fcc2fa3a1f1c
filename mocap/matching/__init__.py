"""Which moments of two clips are alike? Point clouds, distance grids, and the transitions they allow.

The metric is that of [KGP02, 3.1]: lay one window of frames on the other by the best planar transform, and
measure how far apart the points still are. At its local minima one clip can pass into another. (*Motion
matching*, as games use it, is another method: it looks for the next frame while the character walks.)

Reading order (notebooks 02, 05, 15)
--------------------------------
1. `point_clouds`: the points a motion drives, and how to align two clouds of them
2. `distance_grids`: all windows against all, by matrix products
3. `other_metrics`: the homework's two metrics, and why they fail; `Metric`, the signature that all have
4. `lower_bound`: a bound of the distance that is nearly as large, with its derivation
5. `near_pairs`: the few pairs of windows that the bound leaves, and their distances
6. `minima`: the entries of a grid that are lower than all eight neighbours, however large it is
7. `transitions`: where one clip can pass into another
8. `time_paths`: which frame of one clip belongs to which of another
9. `tuned`: the constants that trials chose

References
----------
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
.. [FRM94] C. Faloutsos, M. Ranganathan, Y. Manolopoulos, *Fast Subsequence Matching in Time-Series
   Databases*, SIGMOD 1994, doi 10.1145/191839.191925.
.. [KG03] L. Kovar, M. Gleicher, *Flexible Automatic Motion Blending with Registration Curves*, SCA 2003,
   doi 10.5555/846276.846307.
.. [SC78] H. Sakoe, S. Chiba, *Dynamic Programming Algorithm Optimization for Spoken Word Recognition*, IEEE
   Transactions on Acoustics, Speech, and Signal Processing 26, 1978, doi 10.1109/TASSP.1978.1163055.
.. [Din67] W. Dinkelbach, *On Nonlinear Fractional Programming*, Management Science 13, 1967,
   doi 10.1287/mnsc.13.7.492.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)
