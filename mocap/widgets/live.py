"""The base of all live widgets: what browser and Python share, and what stays when the kernel has ended.

JupyterLab shows a widget whose kernel has ended as an error, and prefers that to the picture beside it. So a
cell has two outputs here, the picture and the widget. A rule hides the picture while the widget lives, and
the widget's output when it does not. In the dark theme it dims the notebook's pictures, which are drawn on
white paper: inverted, they would have other colours than the text names.
"""

from functools import cache
from pathlib import Path
from typing import Any, ClassVar

from mocap.errors import missing
from mocap.widgets.embedding import joined

WIDGET = "application/vnd.jupyter.widget-view+json"  # the name of a model that ends with its kernel
STILL, LIVE = "mocap-still", "mocap-live"  # classes of the picture and of the widget

_OUTPUT = ".jp-OutputArea-child"
_RULE = f"""<style>
{_OUTPUT}:has(.{STILL}):has(+ {_OUTPUT} .{LIVE}) {{ display: none; }}
{_OUTPUT}:has(.{STILL}) + {_OUTPUT}:not(:has(.{LIVE})) {{ display: none; }}
[data-jp-theme-light=false] .jp-Cell img {{ filter: brightness(.8); border-radius: 4px; }}
</style>"""


class Live:
    """What a live widget is without its traits.

    A `shared` name is a trait that the browser knows as well. Where there is a method `check_` and its name,
    that gives the value to take, or raises why it is refused.
    """

    scripts: ClassVar[tuple[Path, ...]]
    shared: ClassVar[dict[str, Any]]  # names, with their values at first


@cache
def widget(kind: type[Live]) -> type[Any]:
    """Make the class of a live widget, once; it needs anywidget, which may not be installed."""
    try:
        import anywidget
        import traitlets
        from ipywidgets import ValueWidget
    except ImportError as error:
        raise missing("What is live in a notebook needs anywidget", "notebooks") from error
    parts: dict[str, Any] = {name: traitlets.Any(value).tag(sync=True) for name, value in kind.shared.items()}
    for name in kind.shared:
        if check := getattr(kind, f"check_{name}", None):
            parts[f"_{name}"] = traitlets.validate(name)(
                lambda self, proposal, check=check: check(self, proposal["value"])
            )
    bases = (kind, anywidget.AnyWidget, *([ValueWidget] if "value" in parts else []))
    return type(kind.__name__, bases, {"_esm": joined(*kind.scripts), **parts})


def display_live(still: tuple[dict[str, str], dict[str, Any]], widget: Any, what: str = "controls") -> None:  # noqa: ANN401
    """Show a picture and a widget as two outputs of a cell, of which the reader sees one.

    Parameters
    ----------
    still : the data and the metadata of a picture, as `Picture` and `Player` give them.
    widget : the widget.
    what : the reader gets by running the cell again.
    """
    from IPython.display import display

    data, metadata = still
    widget.add_class(LIVE)
    again = f"<p><small>Run this cell to get its {what}.</small></p>"
    page = f'<div class="{STILL}">{data["text/html"]}{again}</div>{_RULE}'  # where the rule finds the picture
    display(data | {"text/html": page}, metadata=metadata, raw=True)  # type: ignore[no-untyped-call]
    live = {"version_major": 2, "version_minor": 0, "model_id": widget.model_id}
    display({WIDGET: live}, raw=True)  # type: ignore[no-untyped-call]
