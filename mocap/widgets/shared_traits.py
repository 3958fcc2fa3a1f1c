"""The traits of a live widget, which browser and Python share. This module needs anywidget and ipywidgets."""

from pathlib import Path
from typing import Any

from mocap.errors import missing
from mocap.widgets.embedding import joined

try:
    import ipywidgets as ipywidgets
    import traitlets
    from anywidget import AnyWidget as AnyWidget
    from ipywidgets import ValueWidget as ValueWidget
    from traitlets import validate as validate
except ImportError as error:
    raise missing("What is live in a notebook needs anywidget and ipywidgets", "notebooks") from error


def shared(value: Any) -> Any:  # noqa: ANN401
    """Create a trait that is synchronised with the browser, with its initial value."""
    return traitlets.Any(value).tag(sync=True)


class Naming(AnyWidget):
    """A widget that sets the accessible names of the other widgets, for screen readers."""

    _esm = joined(Path(__file__).with_name("naming.js"))
    alt = shared("")
