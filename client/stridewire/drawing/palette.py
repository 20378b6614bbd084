"""The colours of pictures, told apart also by colour-blind people."""

LEFT = "#1f6fd0"
RIGHT = "#d9581a"
MIDDLE = "#343a42"
PLANTED = "#35a35a"
GRID = "#d5d9de"
SHADOW = "#e4e7ea"


def side_colour(side: int) -> str:
    """Return the colour of a side: 1 left, -1 right, 0 middle."""
    return {1: LEFT, -1: RIGHT}.get(side, MIDDLE)
