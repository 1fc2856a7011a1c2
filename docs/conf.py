"""How these pages are built: `sphinx-build -W docs FOLDER`, with the extra `docs`. The result needs no network."""

from __future__ import annotations

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.writers.html5 import HTML5Translator

project = "Drawing-arm planner"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
napoleon_use_ivar = True
nitpick_ignore_regex = [
    ("py:.*", r"(?!planner\.\w+$).*")
]  # types of other libraries and of the private parts have no pages
myst_enable_extensions = ["dollarmath"]
myst_fence_as_directive = {"math"}  # so that GitHub shows the formulas too
myst_heading_anchors = 3
html_theme = "furo"
html_title = project
html_static_path = ["_static"]
html_css_files = ["pages.css"]
html_copy_source = False
html_show_copyright = False
html_math_renderer = "mathml"


def _inline(writer: HTML5Translator, node: nodes.math) -> None:
    writer.body.append(convert(node.astext()))
    raise nodes.SkipNode


def _block(writer: HTML5Translator, node: nodes.math_block) -> None:
    writer.body.append(f'<div class="math">{convert(node.astext(), display="block")}</div>')
    raise nodes.SkipNode


def setup(app: Sphinx) -> None:
    """Formulas are MathML, which browsers know by themselves, where the usual script would come from a network."""
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
