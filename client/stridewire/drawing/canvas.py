"""Empty figures of matplotlib, which is loaded here and nowhere before."""

from typing import TYPE_CHECKING

from stridewire._errors import StridewireError

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def new_figure(width: float, height: float) -> "Figure":
    """Return an empty figure; not pyplot's, which keeps figures and wants a screen.

    Args:
        width: In inches.
        height: In inches.

    Raises:
        StridewireError: If matplotlib is not installed.
    """
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ModuleNotFoundError as error:
        raise StridewireError(
            "drawing needs matplotlib: pip install 'stridewire[server]'"
        ) from error
    figure = Figure(figsize=(width, height), facecolor="white")
    FigureCanvasAgg(figure)
    return figure
