"""Coefficients and networks that ship, each beside a card that says where it comes from."""
