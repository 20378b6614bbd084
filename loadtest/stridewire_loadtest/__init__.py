"""The load test: an open-loop generator, scenarios, reports."""
