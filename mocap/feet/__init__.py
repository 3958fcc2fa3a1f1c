"""Feet that stand: find footplants, and clean up footskate in the five steps of [KSG02].

Captured feet drift while they stand, and blended feet slide. `clean_up` gives each plant one place and bends
the legs so that the foot stays there. The files below follow the steps of the paper.

Reading order (notebook 04)
---------------------------
1. `footplants`: when does a foot stand, and where?
2. `leg_track`: one leg over a clip: its reach by the flexion of its knee, and its pose (step 4)
3. `ankle_targets`: positions of ankles, and the paths between footplants (steps 1, 2 and 5)
4. `hip_heights`: how the root's rise and the list of the pelvis move the hips (step 3)
5. `least_bending`: the hips and the knees, all at once (steps 3 and 4)
6. `releasing`: which plants are shortened if not all of them can be held
7. `footskate`: the five steps in one function
8. `tuned`: the constants that trials chose

How the constants were set
--------------------------
Each file names its constants at the top, each with its unit and with what another value does. Those of
plants were measured on the bundled clips, whose true plants are known, and give an F1 of 0.998 in the worst
of them; a foot stands for 50 % of the time of captured walks and 33 % of runs'. Those of the
clean-up are in `tuned`. They were chosen at 30, 60 and 120 Hz on 123 clips (walks, runs, jumps, dance) of
several skeletons, and tried on 38 others: `python figures/clean_knees.py` prints, clip by clip, how much
faster than usual in the second around a knee's angle changes, how far feet slide, and how many planted frames
are kept. `python figures/tune/feet.py` repeats the trials of each constant.

References
----------
.. [KSG02] L. Kovar, J. Schreiner, M. Gleicher, *Footskate Cleanup for Motion Capture Editing*, SCA 2002,
   doi 10.1145/545261.545277.
"""

from mocap._shared import faces

__getattr__, __dir__, __all__ = faces.attach(__name__, __file__)
