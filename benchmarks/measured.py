"""Run a program from a small process, and write what it used to a file.

The memory that the system accounts to a process includes that of the process that started it, so
the one that starts it must be small.  Run as ``python -S -E measured.py USAGE PROGRAM…``;
the file then holds seconds of processor time and MiB.
"""

import os
import sys


def main(usage_file: str, *program: str) -> int:
    child = os.fork()
    if child == 0:
        try:
            os.execvp(program[0], program)
        finally:
            os._exit(127)
    _, status, usage = os.wait4(child, 0)
    with open(usage_file, "w", encoding="ascii") as report:
        report.write(f"{usage.ru_utime + usage.ru_stime} {usage.ru_maxrss / 1024}")
    return os.waitstatus_to_exitcode(status) % 256


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
