"""The judge: what good motion is, in figures beside those of the captured motion."""
