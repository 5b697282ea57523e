"""A campaign of mutants and forgeries against the checker, judged by an oracle of its own.

    python -m tests.assurance.attack 500000        # some ten minutes on two idle processors
    python -m tests.assurance.attack 10000 --kinds parametric_fixed_spectrum parametric_rank
    python -m tests.assurance.attack --only 1234   # one try again, with its document
    python -m tests.assurance.attack 100000 --weakened FILE   # without each condition

The oracle in ``tests/oracle/certificates`` is written from ``mcexact/answer/FORMAT.md`` alone, and
decides whether claims are true; it imports neither the checker nor any other part of the package.
"""
