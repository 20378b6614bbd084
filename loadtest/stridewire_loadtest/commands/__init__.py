"""Commands of the load test."""
