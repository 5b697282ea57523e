"""Write the table of the paper's statements into README.md, from the ledger of the package.

Run as ``python proofs/ledger_table.py`` with the package installed, or by ``make ledger``.
"""

from __future__ import annotations

from pathlib import Path

from mcexact.reproduce.ledger import table

README = Path(__file__).parent / "README.md"
BEGIN, END = "<!-- the ledger: made by make ledger -->\n", "<!-- end of the ledger -->\n"


def renewed(text: str) -> str:
    """The text with the table as the ledger has it now."""
    before, found, rest = text.partition(BEGIN)
    _, closed, after = rest.partition(END)
    if not found or not closed:
        raise SystemExit(f"{README}: the marks around the table are missing")
    return before + BEGIN + table() + END + after


if __name__ == "__main__":
    README.write_text(renewed(README.read_text(encoding="utf-8")), encoding="utf-8")
