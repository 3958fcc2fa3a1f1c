"""Walks, jogs, sneaks and a jump like people's, generated from tables of figures.

`figures/bundled_clips.py` makes the bundled clips of them. `python figures/walking_sheet.py OUT [FOLDER ...]`
draws them beside captured people, and measures both.

1. `gait`: the movements of a body in one cycle; `walker.toml` holds its figures
2. `gait_timing`: distance, phase and gait, frame by frame
3. `footsteps`: footplants, and how a foot rolls over them
4. `footplanning`: where the feet go
5. `walking_body`: the body that walks, and its legs
6. `leg_motion`: stance, the height of the pelvis, and swing
7. `generated`: walks along any path
8. `two_bone_ik`: limbs of two bones, in closed form
9. `jumping`: a jump
"""

from walking.generated import generate, generate_walk

__all__ = ["generate", "generate_walk"]
