"""Write the paper's statements into STATEMENTS.md, those that are not proved into OPEN.md, and its
examinations into README.md.

Run as ``python proofs/ledger_table.py`` with the package installed, or by ``make ledger``.
"""

from __future__ import annotations

from pathlib import Path

from mcexact.reproduce.notebook import open_table, statement_table, table

FOLDER = Path(__file__).parent
TABLES = {"README.md": table, "STATEMENTS.md": statement_table, "OPEN.md": open_table}
"""The pages with a table, and what makes it."""
BEGIN, END = "<!-- the ledger: made by make ledger -->\n", "<!-- end of the ledger -->\n"


def renewed(text: str, made: str) -> str:
    """The text with the table as the package makes it now."""
    before, found, rest = text.partition(BEGIN)
    _, closed, after = rest.partition(END)
    if not found or not closed:
        raise SystemExit("the marks around the table are missing")
    return before + BEGIN + made + END + after


if __name__ == "__main__":
    for name, made in TABLES.items():
        page = FOLDER / name
        page.write_text(renewed(page.read_text(encoding="utf-8"), made()), encoding="utf-8")
