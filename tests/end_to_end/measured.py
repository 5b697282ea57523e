"""Run a program from a small process, and write what it used to a file.

The memory that the system accounts to a process includes that of the process that started it, so
the one that starts it must be small.  Run as ``python -S -E measured.py USAGE PROGRAM…``.
"""

import os
import sys

child = os.fork()
if child == 0:
    try:
        os.execvp(sys.argv[2], sys.argv[2:])
    finally:
        os._exit(127)
_, status, usage = os.wait4(child, 0)
with open(sys.argv[1], "w", encoding="ascii") as report:
    report.write(f"{usage.ru_utime + usage.ru_stime} {usage.ru_maxrss / 1024}")
sys.exit(os.waitstatus_to_exitcode(status) % 256)
