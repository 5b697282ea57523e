"""A campaign of mutants and forgeries against the checker, judged by an oracle of its own.

    python -m tests.attack 500000        # an hour on two processors
    python -m tests.attack --only 1234   # one try again, with its document


The oracle in ``oracle/`` is written from ``mcexact/answer/FORMAT.md`` alone, and decides whether
claims are true; it imports neither the checker nor any other part of the package.
"""
