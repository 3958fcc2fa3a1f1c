"""The command `mocap loop`: the best cycle in a clip, closed."""

import math
import warnings
from pathlib import Path
from typing import Annotated

from mocap import editing, quality
from mocap.cli.options import Clean, Reading, check_out, number, tell, write_out
from mocap.errors import MocapWarning

LASTS = number(0.2, 600)  # seconds; no shorter than the seam
POOR = 0.06  # metres RMS; the cycles of eight walks had seams of 0.5 to 3 cm
LITTLE = 0.15  # metres; cycles of walks miss 1 to 9 cm, a pose held before a run misses 30


def loop(
    clip: Path,
    *,
    out: Path = Path("loop.bvh"),
    reading: Reading,
    shortest: Annotated[float, LASTS] = 0.4,
    longest: Annotated[float, LASTS] = 3.0,
    straight: bool = False,
    clean: Clean = False,
    inertialize: bool = False,
    times: Annotated[int, number(1, 1000, int)] = 1,
) -> None:
    """Cut the best cycle out of a clip and close it.

    Find the stretch of a clip that makes the best cycle: its ends are alike, and it holds most of what the
    clip does. Close it, and write it as .bvh, .glb, .amc or .npz. Its last frame is its first one, farther on
    over the ground.

    Parameters
    ----------
    clip : an .amc, .bvh or AMASS .npz file.
    out : file to write.
    shortest : seconds of a cycle at least.
    longest : seconds of a cycle at most.
    straight : take out the turn of a round: it goes on straight ahead.
    inertialize : close it by an offset that fades, not by a blend.
    times : rounds to write.

    Notes
    -----
    Example: mocap loop walk.bvh --straight --clean -o loop.bvh
    """
    check_out("cycle", out, (".bvh", ".glb", ".amc", ".npz"), [clip])
    motion = reading.load(clip)
    found = editing.find_loop(motion, seconds=(shortest, longest))
    seam, missed = (f"{100 * metres:.0f} cm" for metres in (found.seam, found.missed))
    if found.seam > POOR:
        said = f"{clip}: the ends of the best cycle are {seam} apart: it may leap there."
        warnings.warn(said, MocapWarning, stacklevel=1)
    if found.missed > LITTLE:
        said = f"{clip}: the clip's other poses are {missed} away: it may hold no whole cycle."
        warnings.warn(said, MocapWarning, stacklevel=1)
    way = "inertialize" if inertialize else "blend"
    cycle = editing.loop(motion, found, way=way, straight=straight, clean=clean)
    turn = quality.inspect(cycle).turn
    step = math.hypot(*(cycle.root_positions[-1] - cycle.root_positions[0])[[0, 2]])
    side = "left" if turn > 0 else "right"
    tell(cycle=f"frames {found.first} to {found.last}, {cycle.duration:.2f} s")
    tell(seam=f"{100 * found.seam:.1f} cm RMS")
    tell(misses=f"{100 * found.missed:.1f} cm of the clip's other poses, on average")
    tell(**{"a round": f"{step:.2f} m, turns {side} by {abs(math.degrees(turn)):.0f}°"})
    write_out(editing.repeated(cycle, times), out, widen=True)
