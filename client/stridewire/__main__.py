"""`python -m stridewire`: the command line."""

from stridewire.commands import main

main()
