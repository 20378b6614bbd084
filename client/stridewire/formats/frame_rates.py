"""Frame rates as people mean them: 0.0333 is 30 frames per second."""

_WHOLE = (24, 25, 30, 40, 48, 50, 60, 72, 75, 90, 100, 120, 144, 150, 180, 200, 240)
_NTSC = (24000 / 1001, 30000 / 1001, 60000 / 1001, 120000 / 1001)


def named_rate(frame_time: str) -> float:
    """Return frames per second of a frame time in seconds, as written.

    A usual rate whose frame time agrees to the last written digit is taken (whole rates first),
    else the inverse.
    """
    seconds = float(frame_time)
    digits = frame_time.lower().partition("e")[0].partition(".")[2]
    slack = 0.0 if "e" in frame_time.lower() else 10.0 ** -len(digits)
    slack = min(max(slack, 1e-7 * seconds), 0.05 * seconds)
    for rates in (_WHOLE, _NTSC):
        near = [rate for rate in rates if abs(1.0 / rate - seconds) <= slack]
        if near:
            return float(min(near, key=lambda rate: abs(1.0 / rate - seconds)))
    return 1.0 / seconds
