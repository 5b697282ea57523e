"""Write the paper's statements into STATEMENTS.md and its examinations into README.md.

Run as ``python proofs/ledger_table.py`` with the package installed, or by ``make ledger``.
"""

from __future__ import annotations

from pathlib import Path

from mcexact.reproduce.ledger import table
from mcexact.reproduce.statements import statement_table

README = Path(__file__).parent / "README.md"
STATEMENTS = Path(__file__).parent / "STATEMENTS.md"
BEGIN, END = "<!-- the ledger: made by make ledger -->\n", "<!-- end of the ledger -->\n"


def renewed(text: str, made: str) -> str:
    """The text with the table as the package makes it now."""
    before, found, rest = text.partition(BEGIN)
    _, closed, after = rest.partition(END)
    if not found or not closed:
        raise SystemExit("the marks around the table are missing")
    return before + BEGIN + made + END + after


if __name__ == "__main__":
    for path, made in ((README, table()), (STATEMENTS, statement_table())):
        path.write_text(renewed(path.read_text(encoding="utf-8"), made), encoding="utf-8")
