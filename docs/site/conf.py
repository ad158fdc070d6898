"""Sphinx: the pages of docs and the top of the repository, the catalogue of laws, the API."""

project = "cardume"
author = "The cardume maintainers"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
source_suffix = {".md": "markdown"}
root_doc = "docs/index"
html_theme = "furo"
html_title = "cardume"
html_css_files = ["site.css"]
html_static_path = ["static"]
html_copy_source = False
html_show_sphinx = False
myst_heading_anchors = 4
suppress_warnings = ["myst.header"]  # a page may go from its title to third-level headings
autodoc_typehints = "description"
autodoc_member_order = "bysource"
nitpicky = False
