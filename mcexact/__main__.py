"""`python -m mcexact` is the command line."""

from mcexact.cli import main

main()
