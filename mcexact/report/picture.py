"""Figures with text alternatives, and their embedding in a page."""

from __future__ import annotations

import base64
import io
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, eq=False)
class Picture:
    """A matplotlib figure with a description in words.

    Attributes
    ----------
    figure : matplotlib.figure.Figure
        A figure that does not depend on the state of pyplot; change its style before `embedded`.
    title : str
    alternative : str
        A description for readers who cannot see the figure.
    """

    figure: Any
    title: str
    alternative: str

    def embedded(self) -> EmbeddedPicture:
        """Return the picture as an SVG to embed, always with the same bytes."""
        import matplotlib

        image = io.BytesIO()
        with matplotlib.rc_context({"svg.hashsalt": "mcexact", "svg.fonttype": "path"}):
            self.figure.savefig(image, format="svg", metadata={"Date": None, "Creator": None})
        text = base64.b64encode(image.getvalue()).decode("ascii")
        width = float(self.figure.get_figwidth())
        uri = f"data:image/svg+xml;base64,{text}"
        return EmbeddedPicture(self.title, self.alternative, uri, width)


@dataclass(frozen=True)
class EmbeddedPicture:
    """A picture for a page.

    Attributes
    ----------
    title, alternative : str
    uri : str
        A ``data:`` address that contains the whole image.
    width : float
        The width in inches.
    """

    title: str
    alternative: str
    uri: str
    width: float
