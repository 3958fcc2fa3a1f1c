"""What figures show, held against what they showed when somebody last looked at them.

Beside a table of pictures lies what they showed, as `drawn.json`, and of a few the picture itself. After a
change that is meant, look at the pictures, and write all anew: MOCAP_DRAW_ANEW=1 pytest tests/plotting
tests/course/diagrams -n 0
"""

import json
import os
import shutil
from pathlib import Path

import numpy as np
import pytest
from matplotlib.collections import Collection, LineCollection, PathCollection
from matplotlib.colors import to_rgba_array
from matplotlib.image import AxesImage
from matplotlib.lines import Line2D
from matplotlib.patches import FancyArrowPatch, Patch
from matplotlib.spines import Spine
from matplotlib.testing.compare import compare_images
from matplotlib.testing.decorators import remove_ticks_and_titles
from matplotlib.text import Annotation, Text
from matplotlib.ticker import FixedLocator
from mpl_toolkits.mplot3d.art3d import Line3DCollection

from mocap.plotting.picture import figure_of

# Where an artist is, in the units of its axes.
PLACES = {
    Line2D: lambda line: [line.get_data_3d() if hasattr(line, "get_data_3d") else line.get_xydata()],
    Line3DCollection: lambda lines: lines._segments3d,
    LineCollection: lambda lines: lines.get_segments(),
    PathCollection: lambda dots: [dots.get_offsets(), dots.get_sizes()],
    Collection: lambda parts: [path.vertices for path in parts.get_paths()],
    AxesImage: lambda image: [np.ma.filled(image.get_array().astype(float), -1), image.get_extent()],
    Annotation: lambda note: [note.xy, note.xyann],
    Text: lambda text: [text.get_position()],
    FancyArrowPatch: lambda arrow: [arrow.get_linewidth()],
    Patch: lambda patch: [patch.get_patch_transform().transform(patch.get_path().vertices)],
}
PIXELS_PER_INCH = 40  # of a stored picture
ROOT_MEAN_SQUARE = 1  # of the differences between stored and new pixels, of 255
COLOURS = ("color", "facecolor", "edgecolor", "markeredgecolor")
SIZES = ("linewidth", "zorder", "alpha", "markersize", "fontsize")
MARKS = ("marker", "markevery", "drawstyle", "ha", "va")


def sketch(figure):
    """Sum up a figure: its words, and of each kind of artist how many, where, and of which looks."""
    shown, words = {}, [text.get_text() for text in figure.texts]
    for ax in figure.axes:
        frame = (ax.patch, ax.title, ax._left_title, ax._right_title)
        artists = [a for a in ax.get_children() if a.get_visible() and a not in frame]
        legends = [legend for legend in (ax.get_legend(), *figure.legends) if legend]
        said = [*frame[1:], ax.xaxis.label, ax.yaxis.label]
        words += [t.get_text() for t in (*said, *(t for legend in legends for t in legend.get_texts()))]
        fixed = [axis for axis in (ax.xaxis, ax.yaxis) if isinstance(axis.get_major_locator(), FixedLocator)]
        ticks = [tick for axis in fixed for tick in axis.get_majorticklocs()]
        shown.setdefault("axes", []).extend([*ax.get_xlim(), *ax.get_ylim(), *ticks])
        for artist in artists:
            kind = next((kind for kind in PLACES if isinstance(artist, kind)), None)
            if kind and not isinstance(artist, Spine):
                words += [artist.get_text()] if isinstance(artist, Text) else []
                shown.setdefault(kind.__name__, []).extend([1.0, *numbers_of(artist, PLACES[kind])])
    shown["words"] = [*"\n".join(filter(None, words)).encode()]
    weights = np.cos(np.arange(max(map(len, shown.values()))))  # so that none can take another's place
    numbers = {kind: np.nan_to_num(np.array(values, float)) for kind, values in shown.items()}
    return {kind: [len(row), round(float(row @ weights[: len(row)]), 6)] for kind, row in numbers.items()}


def numbers_of(artist, places):
    """Give the numbers of an artist: where it is, its colours, its sizes, and the letters of its marks."""
    colours = [to_rgba_array(look) for look in looks(artist, COLOURS) if not np.array_equal(look, "auto")]
    sizes = [size for size in looks(artist, SIZES) if size is not None]
    marks = [*str(looks(artist, MARKS)).encode()]
    return np.concatenate([*map(np.ravel, (*places(artist), *colours, *sizes, marks))])


def looks(artist, names):
    return [getattr(artist, f"get_{name}")() for name in names if hasattr(artist, f"get_{name}")]


def hold(file, name, pictures):
    """Compare pictures, or artists on them, with what is kept of them beside a test."""
    kept_in = Path(file).with_name("drawn.json")
    now = [sketch(figure_of(one)) for one in pictures]
    if os.environ.get("MOCAP_DRAW_ANEW"):
        kept = json.loads(kept_in.read_text("utf-8")) if kept_in.exists() else {}
        rows = [f"{json.dumps(n)}: {json.dumps(some)}" for n, some in (kept | {name: now}).items()]
        kept_in.write_text("{\n" + ",\n".join(rows) + "\n}\n", "utf-8")
    all_kept = json.loads(kept_in.read_text("utf-8"))[name]
    for number, (one, kept) in enumerate(zip(now, all_kept, strict=True)):
        assert one.keys() == kept.keys(), f"{name}, picture {number}"
        for kind, sums in one.items():
            assert sums == pytest.approx(kept[kind], rel=1e-6, abs=1e-5), f"{name}, picture {number}: {kind}"


def compare_with_baseline(figure, baseline, folder):
    """Compare the pixels of a figure with a stored picture, or store it.

    Letters differ between versions of matplotlib, and so does the layout around them: no text is drawn.
    """
    remove_ticks_and_titles(figure)
    drawn = baseline if os.environ.get("MOCAP_DRAW_ANEW") else folder / baseline.name
    figure.savefig(drawn, dpi=PIXELS_PER_INCH, metadata={"Software": None})
    stored = folder / f"stored-{baseline.name}"  # the picture of the difference lies beside this copy
    shutil.copyfile(baseline, stored)
    difference = compare_images(stored, drawn, tol=ROOT_MEAN_SQUARE)
    assert difference is None, difference
