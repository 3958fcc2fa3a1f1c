"""Constants of the searches that trials chose; `figures/tune/matching.py` runs the trials again.

They change the time that a search takes, and not what it finds.
"""

from __future__ import annotations

from mocap._shared.records import dataclass


@dataclass(frozen=True)
class Tuned:
    """Each constant with its unit, and the reason for its value."""

    # Grids of distances
    small_grid: int = 500_000  # entries, some 10 ms. For a smaller grid threads cost more than they save
    tile: tuple[int, int] = (256, 640)  # rows and columns of a product. Larger tiles leave a core's cache

    # All pairs, or a lower bound
    few_frames: int = 20_000  # frames up to which the work is done in 64 bits. Beyond, memory counts more
    few_windows: int = 5000  # windows up to which all pairs are measured. Of more, the bound spares time
    block: int = 1280  # windows on a side of a block of products. Larger blocks take more memory
    wide_block: int = 8192  # windows on a side of a block that is searched by the bound, whose trees pay then
    sparse: float = 0.05  # fraction of near pairs up to which the bound is quicker than products

    # The bound, and the trees that it prunes
    bound_sample: int = 256  # windows that choose the directions. 64 do nearly as well
    ground_directions: int = 10  # of the vectors g, which make 100 numbers of G. Fewer bound less closely
    height_directions: int = 40  # of the vectors y. Fewer bound less closely
    directions: int = 48  # of f. More leave hardly fewer pairs
    leaf: int = 128  # windows in a leaf at most. Larger leaves test more pairs, smaller ones more often
    pairs_together: int = 1024  # pairs measured at a time, which stay in a core's cache
    pair_sample: int = 600  # windows whose pairs tell whether few are near. More take longer


TUNED = Tuned()
