"""``python -m checker`` and ``python checker``: the command line of the checker alone."""

import sys

if not __package__:
    # Python puts the folder that it runs first in the path; imports need the folder around it.
    import os

    folder = os.path.dirname(os.path.abspath(__file__))
    sys.path[0], __package__ = os.path.split(folder)
    __spec__ = None  # it says that there is no package, and later versions of Python warn of that
    __import__(__package__)

from .command import main

if __name__ == "__main__":
    sys.exit(main())
