"""Settings of the documentation site:  python -m sphinx -W --keep-going -b html docs docs/_build

Nothing is fetched while it builds: no inventories of other projects, no fonts, no scripts from elsewhere.
"""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path

HERE = Path(__file__).parent
ROOT = HERE.parent
sys.path.insert(0, str(HERE / "tools"))
sys.path.insert(0, str(ROOT))

project = "hdrive_mbs"
author = "the authors of hdrive_mbs"
release = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["version"]
version = release

extensions = ["myst_parser", "sphinx.ext.autodoc", "collected", "docstrings", "exported", "formulas"]
exclude_patterns = ["_build", "tools"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
suppress_warnings = ["myst.header"]  # the changelog jumps from ## to ###: a page of its own begins with #

html_math_renderer = "browser"
autodoc_typehints = "none"
autodoc_member_order = "bysource"
python_use_unqualified_type_names = True
add_module_names = False
highlight_language = "python"

html_theme = "furo"
html_title = f"hdrive_mbs {release}"
html_copy_source = False
html_show_sphinx = False
html_show_copyright = False
html_static_path = ["static"]
html_css_files = ["site.css"]
