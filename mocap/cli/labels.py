"""The command `mocap label`, which proposes labels for clips."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from mocap.cli.options import Sources
from mocap.cli.outputs import check_out, print_rows
from mocap.cli.stages import bar, timed_stage
from mocap.errors import MocapError
from mocap.files.conversion import find_files


def label(clips: Sequence[Path], *, out: Path = Path("labels.csv"), sources: Sources) -> None:
    """Propose labels for clips, in a table to be corrected by hand.

    The labels are stand, walk and run, by the pace of a body, and turn left and turn right, by the rate of
    its heading. A clip that has labels, such as an .npz file, keeps them. Each row of the table is a stretch
    of a clip, with the columns clip, from, to and label: times are in seconds, as in 1.5s, or frames of the
    clip, as in 45, and a stretch may have several labels. mocap graph reads the table by --labels.

    Parameters
    ----------
    clips : motion files, or folders of them.
    out : file to write, .csv. A file that exists is not replaced, because it may contain corrections.

    Notes
    -----
    Example: mocap label clips/ -o labels.csv
    """
    paths = find_files(clips)
    check_out("table of labels", out, paths, [".csv"])
    if out.exists():
        raise MocapError(f"{out} exists, and may contain corrections: choose another name with -o.")
    with timed_stage("loading packages"):
        from mocap.files.label_tables import save_labels  # the help needs no NumPy
        from mocap.quality.label_proposals import propose_labels
    motions, _ = sources.load(paths, clips)
    rows = [row for clip in bar("labelling")(motions) for row in propose_labels(clip)]
    save_labels(out, rows)
    counts = Counter(row.label for row in rows)
    print_rows(labels=", ".join(f"{name} {count}" for name, count in sorted(counts.items())) or "none")
    print_rows(wrote=f"{out}: correct it, then mocap graph --labels {out}")
