"""Matching: feature schemas, features, the index and the search over it."""
