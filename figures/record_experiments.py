"""Record the experiments of the course's notebooks as pictures, for its site, where no Python runs.

    MOCAP_DATA=FOLDER python figures/record_experiments.py [NOTEBOOK ...]

Each notebook runs in its own kernel, some of them for minutes. `notebooks/recordings` then has a file for
each notebook with experiments. `mocap course site` shows the recordings of cells that have not changed since.
"""

import json
import sys
from pathlib import Path

from mocap._shared.atomic import make_folder, write_file
from mocap.course.notebooks import notebooks_in, read
from mocap.course.site import recorded_of, recordings_file

NOTEBOOKS = Path(__file__).parents[1] / "notebooks"


def main(names: list[str]) -> None:
    """Record notebooks, or all of the course."""
    for file in [Path(name) for name in names] or notebooks_in(NOTEBOOKS):
        recordings = list(recorded_of(file, read(file)).values())
        if not recordings:
            continue
        path = recordings_file(file)
        make_folder(path.parent)
        write_file(path, json.dumps(recordings, separators=(",", ":")))
        pictures = sum(len(recording["pictures"]) for recording in recordings)
        size = path.stat().st_size / 1e3
        print(f"{path.name}: {len(recordings)} experiments, {pictures} pictures, {size:.0f} kB")


if __name__ == "__main__":
    main(sys.argv[1:])
