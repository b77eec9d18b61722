# How Sphinx writes the book. build_book.py prepares its source folder and sets the environment.
import os
import sys

sys.path.insert(0, os.environ["CAPSTAN_BOOK"])

project = "Capstan"
author = "The capstan authors"
version = release = os.environ["CAPSTAN_VERSION"]
language = "en"

extensions = ["myst_parser", "math_as_mathml", "fixed_theme"]
myst_enable_extensions = ["dollarmath", "colon_fence", "deflist"]
myst_heading_anchors = 3
html_math_renderer = "mathml"
nitpicky = True
smartquotes = False  # options begin with two hyphens

html_theme = "furo"
html_title = f"Capstan {version}"
html_static_path = ["static"]
html_css_files = ["book.css"]
html_js_files = ["book.js"]
html_copy_source = False
html_show_sourcelink = False
html_show_copyright = False
html_show_sphinx = False
html_last_updated_fmt = None  # the same book for the same source
html_extra_path = ["extra"]
pygments_style = "default"  # its colours have contrast enough
pygments_dark_style = "native"
