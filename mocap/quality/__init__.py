"""Measures: what is wrong with a clip, how good a seam is, and whether a jump falls as bodies fall.

A seam is compared with the clips' own windows of the same length: a jump that the clips have themselves is
nothing special. A new measure of clips goes into `clip_flaws`, one of seams into `seam_measures`,
one of a blend beside its two clips into `blend_measures`, and one of something else into a file of its own.

Reading order (notebooks 01, 04, 09 to 11)
----------------------------------------
1. `clip_flaws`: a clip's length, its path and its flaws
2. `standing_feet`: how far planted feet slide
3. `seam_measures`: a seam in five numbers
4. `blend_measures`: what the blend itself adds, sliding feet, turning knees
5. `falling`: the centre of mass, and the gravity that a flight shows
6. `joint_limits`: joints that bend beyond what people's do
7. `judgements`: what is said of a motion, and a table of many
8. `judging`: any motion in a few numbers, each over its limit

References
----------
.. [AAOS65] American Academy of Orthopaedic Surgeons, *Joint Motion: Method of Measuring and Recording*, 1965.
.. [Winter09] D. A. Winter, *Biomechanics and Motor Control of Human Movement*, 4th ed., Wiley 2009.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "blend_measures": ["added_jolt", "blend_jolts", "ground_slides", "knee_turns"],
        "clip_flaws": ["inspect", "warn_of_size"],
        "falling": ["SEGMENTS", "Segment", "centre_of_mass", "gravity"],
        "judgements": ["judgement_table"],
        "judging": ["judge"],
        "standing_feet": ["plant_slides"],
        "seam_measures": ["Spread", "jumps", "seam_quality", "spread"],
    },
)
