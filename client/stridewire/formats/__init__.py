"""Motion files: readers give a `SourceMotion` as the file has it; writers take clips."""
