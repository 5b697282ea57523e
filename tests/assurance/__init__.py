"""Programs that put the package to the test for longer than every change can wait.

pytest collects nothing here; what it collects of them stands beside what it tests.
"""
