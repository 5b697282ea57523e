"""How Sphinx builds the documentation: `make docs`, in which every warning is an error."""

from __future__ import annotations

import re
import sys
from pathlib import Path

from sphinx.application import Sphinx

sys.path.insert(0, str(Path(__file__).parent))

from generated_pages import write_pages

import mcexact

project = "mcexact"
author = "the mcexact authors"
copyright = "the mcexact authors"
release = version = mcexact.__version__

extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "numpydoc",
    "myst_nb",
    "sphinx_copybutton",
    "mathml",
]
exclude_patterns = [f"generated/{name}.md" for name in ("exhibits", "designs", "speed")]
templates_path = ["_templates"]
default_role = "py:obj"
nitpicky = False

# The three notebooks are executed whenever the documentation is built.
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 300
myst_enable_extensions = ["dollarmath", "colon_fence", "deflist", "fieldlist", "substitution"]
myst_heading_anchors = 3
myst_substitutions = {"version": release}

# Some names, such as LimitReached, are at the top and in a module as well.
suppress_warnings = ["ref.python"]

autosummary_generate = True
autosummary_imported_members = True
autodoc_typehints = "none"
numpydoc_show_class_members = False
numpydoc_class_members_toctree = False
toc_object_entries_show_parents = "hide"
# Quotes are those of code nearly everywhere, and two minus signs those of an option.
smartquotes = False
# The empty line that ends an example in a source is not shown.
highlight_options = {"pycon": {"stripnl": True}}
copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True
copybutton_line_continuation_character = "\\"

html_math_renderer = "mathml"
html_theme = "pydata_sphinx_theme"
html_title = f"mcexact {release}"
html_static_path = ["_static"]
html_css_files = ["mcexact.css"]
html_show_sourcelink = False
# Pages without others below them need no list of these.
html_sidebars = {
    page: []
    for page in (
        *("index", "install", "tutorial", "overview", "why-exactly", "comparison", "glossary"),
    )
}
html_theme_options = {
    "header_links_before_dropdown": 6,
    "show_toc_level": 2,
    "navbar_align": "left",
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
    "pygments_light_style": "a11y-high-contrast-light",
    "pygments_dark_style": "a11y-high-contrast-dark",
}

write_pages(Path(__file__).parent)


def plain_bars(
    app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]
) -> None:
    """Keep |λ| and K* from being read as markup: docstrings here are plain text.

    Examples with what they print, and blocks that are drawn after ``::``, are no markup anyway.
    """
    example, drawn = False, None
    for k, line in enumerate(lines):
        if not line.strip():
            example = False
            continue
        indent = len(line) - len(line.lstrip())
        if drawn is not None and indent <= drawn:
            drawn = None
        example = example or line.lstrip().startswith(">>>")
        if drawn is None and not example and "``" not in line:
            lines[k] = re.sub(r"(?<!\\)([|*])", r"\\\1", line)
        if drawn is None and line.rstrip().endswith("::"):
            drawn = indent


def with_return_type(
    app: Sphinx,
    what: str,
    name: str,
    obj: object,
    options: object,
    signature: str | None,
    returned: str | None,
) -> tuple[str, str] | None:
    """Show the type that a function returns; the types of its parameters stand below."""
    annotation = getattr(obj, "__annotations__", {}).get("return")
    if signature is None or not isinstance(annotation, str) or annotation == "Any":
        return None
    return signature, annotation


def setup(app: Sphinx) -> None:
    """Let docstrings pass through before numpydoc reads them, and show types of results."""
    app.connect("autodoc-process-docstring", plain_bars, priority=400)
    app.connect("autodoc-process-signature", with_return_type)
