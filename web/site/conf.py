"""Configuration of Sphinx for the documentation site. stage.py makes its sources."""

import os

from pygments.lexers import JsonLexer
from sphinx.highlighting import lexers

lexers["jsonl"] = JsonLexer()  # one JSON text per line

project = "vat"
author = "the vat authors"
copyright = author
release = os.environ["VAT_SITE_VERSION"]

extensions = ["myst_parser", "sphinx.ext.autodoc", "breathe"]
html_theme = "furo"
html_title = f"vat {release}"
html_copy_source = False

myst_heading_anchors = 4
myst_enable_extensions = ["colon_fence"]
# Tables and lists of documents may begin below the first level of headings.
suppress_warnings = ["myst.header"]

autodoc_member_order = "bysource"
autodoc_default_options = {"members": True, "undoc-members": True}

breathe_projects = {"vat": os.environ["VAT_SITE_DOXYGEN"]}
breathe_default_project = "vat"
breathe_default_members = ("members",)
