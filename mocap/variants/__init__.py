"""More clips out of one clip: its mirror image, and the cycle in it.

Clips are expensive. Left and right swapped, every turn to the left is a turn to the right as well; and a
stride that is closed into a cycle walks as long as anybody wants.

Reading order (notebook 10)
---------------------------
1. `mirroring`: left and right swapped, by names and geometry
2. `cycles`: the stretch of a clip that makes the best cycle, closed
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "mirroring": ["Symmetry", "mirror", "mirrored_name", "symmetry"],
        "cycles": ["Loop", "find_loop", "loop"],
    },
)
