"""Feet that stand: footplants found, and footskate cleaned up in the five steps of [KSG02].

Captured feet creep while they stand, and blended feet slide. `clean_up` gives every plant one place and bends
the legs to it; the files below follow the steps of the paper.

Reading order (notebook 04)
---------------------------
1. `footplants`: when does a foot stand?
2. `footprints`: where did it stand?
3. `leg_track`: one leg over a clip: its joints, and how far its knee lets it reach
4. `ankle_targets`: where ankles must be, and how they come there and leave (steps 1, 2 and 5)
5. `root_height`: how far the root rises or falls (step 3)
6. `leg_ik`: bring an ankle to another place (step 4)
7. `knee_smoothing`: no knee jolts more than it did
8. `footskate`: the five steps in one function

References
----------
.. [KSG02] L. Kovar, J. Schreiner, M. Gleicher, *Footskate Cleanup for Motion Capture Editing*, SCA 2002,
   doi 10.1145/545261.545277.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "footplants": ["mark_plants", "runs"],
        "footprints": ["Footprint", "find_footprints"],
        "ankle_targets": ["place_plants"],
        "footskate": ["clean_up"],
    },
)
