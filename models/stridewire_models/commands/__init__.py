"""Commands of training, one file each."""
