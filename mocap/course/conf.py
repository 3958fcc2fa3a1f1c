"""How Sphinx makes the pages of the course: `site` copies the notebooks, and calls it with this file."""

import re
from functools import partial
from typing import Any

from docutils import nodes

from mocap.course.formulas import to_mathml

project = "mocap"
html_title = "Motion graphs"
extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
nb_execution_mode = "off"
nb_render_markdown_format = "gfm"
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
autodoc_typehints = "none"
autodoc_member_order = "bysource"
napoleon_custom_sections = ["Reading order"]
html_theme = "furo"
html_static_path = ["site.css", "moving.js", "live.js", "site.js"]
html_css_files = ["site.css"]
html_js_files = [(name, {"defer": ""}) for name in ("moving.js", "live.js", "site.js")]
html_copy_source = html_show_sourcelink = html_show_copyright = False
html_math_renderer = "mathml"
html_show_search_summary = False  # it would fetch pages, which browsers refuse without a server
pygments_dark_style = "native"


def setup(app: Any) -> None:  # noqa: ANN401 (as Sphinx calls it)
    """Draw formulas as MathML, and keep the first names of authors from being letters of a list."""
    app.connect("autodoc-process-docstring", _keep_authors)
    app.add_html_math_renderer("mathml", (partial(_formula, False), None), (partial(_formula, True), None))


def _formula(block: bool, writer: Any, node: Any) -> None:  # noqa: ANN401
    writer.body.append(to_mathml(node.astext(), block=block))
    raise nodes.SkipNode


def _keep_authors(*event: Any) -> None:  # noqa: ANN401
    lines = event[-1]
    lines[:] = [re.sub(r"^(\.\. \[\w+\] \w)\. ", r"\1\\. ", line) for line in lines]
