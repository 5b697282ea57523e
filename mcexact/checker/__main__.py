"""``python checker``, ``python -m checker`` and the archive: the command line of the checker alone.

No file beside the checker or in the working directory may pass for a module of the standard
library.  What is imported before the path is cleared is a part of the interpreter itself.
"""

import os
import sys
from importlib.machinery import ModuleSpec


def clear_path() -> None:
    """Leave on the path what belongs to the standard library, and nothing else."""
    home = os.path.dirname(os.__file__)
    around, version = os.path.dirname(home), sys.version_info
    kept = {home, os.path.join(home, "lib-dynload")}
    kept.add(os.path.join(around, f"python{version[0]}{version[1]}.zip"))
    for prefix in (sys.base_prefix, sys.base_exec_prefix):
        named = f"python{version[0]}.{version[1]}"
        kept.add(os.path.join(prefix, "DLLs"))
        kept.add(os.path.join(prefix, sys.platlibdir, named, "lib-dynload"))
    if home.endswith(".zip"):
        kept.add(around)
    sys.path[:] = [entry for entry in sys.path if entry in kept]


if __name__ == "__main__":
    folder = os.path.dirname(os.path.abspath(__file__))
    clear_path()
    if not __package__:
        # The folder or an archive of it was run: the package gets a name, but no place on the path.
        from importlib.util import module_from_spec

        __package__, __spec__ = "checker", ModuleSpec("checker", None, is_package=True)
        __spec__.submodule_search_locations = [folder]
        sys.modules[__package__] = module_from_spec(__spec__)
        __spec__ = None  # it is not that of this module, and later versions of Python compare
    try:
        from .command import main

        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
