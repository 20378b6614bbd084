"""Replaying recorded sessions: the same again, or what something else would have made of it."""
