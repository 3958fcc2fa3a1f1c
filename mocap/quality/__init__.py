"""Measures: flaws of a clip, the quality of a seam, the acceleration of a fall, and judgements of motions.

A seam is compared with windows of the same length in the clips, because clips also have jumps of velocity.
A new measure of clips belongs in `clip_flaws`, one of seams in `seam_measures`, and one of whole motions in
`smoothness`, `standing_feet` or `judging`, with its limit.

Reading order (notebooks 01, 04, 09 to 11)
----------------------------------------
 1. `clip_flaws`: a clip's duration, its path and its flaws
 2. `seam_measures`: foot sliding, jumps of velocity at a seam, rotations of the knees
 3. `falling`: the centre of mass, and its acceleration in a flight
 4. `joint_limits`: joint angles and the human range of motion
 5. `measures`: a measured value, and what all measures of a motion start from
 6. `smoothness`: jolts, snapping bones, frozen stretches and trembling
 7. `standing_feet`: feet that slide, or sink below the height at which they stand
 8. `judging`: the measures of any motion, each divided by its limit
 9. `limits`: the limits, which captured people keep
10. `label_proposals`: proposed labels of a clip, by its pace, its turns, and where it stands

References
----------
.. [AAOS65] American Academy of Orthopaedic Surgeons, *Joint Motion: Method of Measuring and Recording*, 1965.
.. [Ale89] R. McN. Alexander, *Optimization and Gaits in the Locomotion of Vertebrates*, Physiological Reviews
   69(4), 1989, doi 10.1152/physrev.1989.69.4.1199.
.. [Winter09] D. A. Winter, *Biomechanics and Motor Control of Human Movement*, 4th ed., Wiley 2009.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)
