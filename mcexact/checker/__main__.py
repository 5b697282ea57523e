"""``python -m checker`` and ``python checker``: the command line of the checker alone."""

import sys

if not __package__:
    # Run as a folder: Python put the folder itself in front; what is needed is the one around it.
    import os

    folder = os.path.dirname(os.path.abspath(__file__))
    sys.path[0], __package__ = os.path.split(folder)
    __spec__ = None  # it says that there is no package, of which later versions of Python complain
    __import__(__package__)

from .command import main

if __name__ == "__main__":
    sys.exit(main())
