"""The page of `stridewire play`: what a browser loads, and what it asks beside the stream."""
