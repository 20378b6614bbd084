"""Commands of the engine, one file each."""
