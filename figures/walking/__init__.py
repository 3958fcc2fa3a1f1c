"""How the bundled clips were made: walks generated from tables of figures.

`python figures/bundled_clips.py` makes them, and stores them where `datasets.sample` reads them.

1. `gait`: what a body does in one cycle; `walker.toml` holds its figures
2. `gait_timing`: how far, in which phase and gait, frame by frame
3. `footsteps`: where the feet go
4. `walking_body`: the body that walks, and its legs
5. `generated`: walks along any path
"""

from walking.generated import generate, generate_walk

__all__ = ["generate", "generate_walk"]
