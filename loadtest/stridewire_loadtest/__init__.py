"""The load test: an open-loop generator in processes of its own, scenarios, reports.

Latency counts from the time at which a control was *scheduled*, whether or not the frames before it
have come: a server that stalls is charged for every frame that it delays.
"""
