"""Live widgets in a notebook, and the pictures that replace them without a kernel.

JupyterLab shows a widget without a kernel as an error, even if the same output contains a picture. Therefore
a cell has two outputs here, the picture and the widget. A CSS rule hides the picture while the widget is
live, and otherwise the output of the widget. In the dark theme, it dims the pictures of the notebook, which
have a white background. Inverted, their colours would not match the names in the text.
"""

from typing import Any

WIDGET = "application/vnd.jupyter.widget-view+json"  # the name of a model that ends with its kernel
STILL = "mocap-still"  # the class of the picture
LIVE = "mocap-live"  # the class of the widget

_OUTPUT = ".jp-OutputArea-child"
_RULE = f"""<style>
{_OUTPUT}:has(.{STILL}):has(+ {_OUTPUT} .{LIVE}) {{ display: none; }}
{_OUTPUT}:has(.{STILL}) + {_OUTPUT}:not(:has(.{LIVE})) {{ display: none; }}
[data-jp-theme-light=false] .jp-Cell img {{ filter: brightness(.8); border-radius: 4px; }}
</style>"""


def display_live(
    still: tuple[dict[str, str], dict[str, Any]],
    widget: Any,  # noqa: ANN401
    control: str = "controls",
) -> None:
    """Show a picture and a widget as two outputs of a cell, of which the reader sees one.

    Parameters
    ----------
    still : the data and the metadata of a picture, as `Picture` and `Player` return them.
    widget : the widget.
    control : a word for the controls that the reader gets by running the cell again.
    """
    from IPython.display import display

    data, metadata = still
    widget.add_class(LIVE)
    hint = f"<p><small>Run this cell to get its {control}.</small></p>"
    page = f'<div class="{STILL}">{data["text/html"]}{hint}</div>{_RULE}'  # the rule selects this class
    display(data | {"text/html": page}, metadata=metadata, raw=True)  # type: ignore[no-untyped-call]
    live = {"version_major": 2, "version_minor": 0, "model_id": widget.model_id}
    display({WIDGET: live}, raw=True)  # type: ignore[no-untyped-call]
