"""Similarity of motions: point cloud distances, distance grids, transitions, and time alignment.

The metric is that of [KGP02, 3.1]: align one window of frames with the other by the best planar transform,
and compute the distance that remains between their points. Its local minima are candidates for transitions.
(*Motion matching* in games is another method: it searches for the next frame while the character walks.)

Reading order (notebooks 02, 05, 15)
--------------------------------
 1. `point_clouds`: the point cloud of a motion, and the alignment of two clouds
 2. `prepared_clouds`: the point clouds of a clip, centred and weighted, with the sums of each window
 3. `window_sums`: sums over the frames of all pairs of windows
 4. `distance_grids`: the distances between all windows of two clips, by matrix products
 5. `other_metrics`: the two metrics of the homework, and their faults; `Metric`, the common signature
 6. `lower_bound`: a tight lower bound of the distance, with its derivation
 7. `near_pairs`: the pairs of windows that the bound does not rule out, and their distances
 8. `minima`: local minima of distance grids of any size
 9. `transitions`: the transitions between clips
10. `time_bands`: bands of a distance grid around its diagonal
11. `time_paths`: dynamic time warping of one clip to another
12. `banded_paths`: the same for long clips, in a band that widens where the path needs it
13. `tuned`: the constants that trials chose

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
