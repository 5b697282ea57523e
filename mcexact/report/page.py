"""Pages of HTML that need no other file: one layout, everything from outside escaped."""

from __future__ import annotations

from functools import cache
from typing import Any


@cache
def _environment() -> Any:
    from jinja2 import Environment, PackageLoader, StrictUndefined

    return Environment(
        loader=PackageLoader("mcexact.report", "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def page(template: str, **content: Any) -> str:
    """Fill a template.

    Parameters
    ----------
    template : str
        Its name without the suffix.
    **content
        Plain text and numbers; `EmbeddedPicture` for pictures.

    Returns
    -------
    str
        A whole document: its styles and images are inside, and a content security policy forbids
        everything else, scripts included.
    """
    text: str = _environment().get_template(f"{template}.html").render(**content)
    return text
