"""Self-contained HTML pages with one layout, in which all inserted texts are escaped."""

from __future__ import annotations

from functools import cache
from typing import Any

from mcexact.report.stamp import stamp


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


def page(template: str, *, dated: bool = True, **content: Any) -> str:
    """Fill a template.

    Parameters
    ----------
    template : str
        The name of the template without its suffix.
    dated : bool
        Whether the page has today's date at its end; see `stamp`.
    **content
        Texts, numbers, and `EmbeddedPicture` for pictures.

    Returns
    -------
    str
        A complete document with its styles and images; a content security policy forbids everything
        else, including scripts.
    """
    text: str = (
        _environment().get_template(f"{template}.html").render(**content, made=stamp(dated=dated))
    )
    return text
