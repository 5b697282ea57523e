"""A figure with its text alternative, and how it is put into a page."""

from __future__ import annotations

import base64
import io
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, eq=False)
class Picture:
    """A matplotlib figure that says in words what it shows.

    Attributes
    ----------
    figure : matplotlib.figure.Figure
        Free of the state of pyplot; restyle it before `embedded`.
    title : str
    alternative : str
        What a reader who does not see it has to know.
    """

    figure: Any
    title: str
    alternative: str

    def embedded(self) -> EmbeddedPicture:
        """The picture as an SVG that stands in the page itself; the same bytes every time."""
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
    """What a page needs of a picture.

    Attributes
    ----------
    title, alternative : str
    uri : str
        A ``data:`` address that holds the whole image.
    width : float
        In inches, as it was drawn.
    """

    title: str
    alternative: str
    uri: str
    width: float


def empty_figure(width: float, height: float) -> Any:
    """A figure of this size in inches, with a white background, that no global state knows."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    return figure
