"""The layout of text: nothing is wider than the terminal, and nothing is lost."""

import io

import pytest

from mcexact.report.text import Table, plain, shorten, show

LONG = Table(
    "a title",
    ("name", "what is said of it", "count"),
    (("first", "words " * 20 + "end", "1"), ("second", "x" * 70, "2")),
    note="a note that is longer than the terminal is wide, and so goes on in a second line",
)


def test_plain_tables_are_aligned_and_have_no_trailing_blanks() -> None:
    table = Table("title", ("a", "long"), (("1", ""), ("100", "2")), note="why")
    assert plain([table]) == "title\n  a    long\n  1\n  100  2\n  (why)\n"


@pytest.mark.parametrize("width", [40, 60, 80, 120])
def test_no_line_is_wider_than_asked_and_every_word_is_there(width: int) -> None:
    text = plain([LONG], width)
    assert max(map(len, text.splitlines())) <= width
    assert text.count("words") == 20 and "end" in text
    assert text.count("x") == 70


def test_a_terminal_gets_the_same_lines() -> None:
    stream = io.StringIO()
    show([LONG, LONG], stream)
    assert stream.getvalue() == plain([LONG, LONG])


@pytest.mark.parametrize("variable", [None, "NO_COLOR"])
def test_titles_and_names_of_columns_are_highlighted_unless_the_user_objects(
    variable: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    stream = io.StringIO()
    monkeypatch.setattr(stream, "isatty", lambda: True, raising=False)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.delenv("NO_COLOR", raising=False)
    if variable:
        monkeypatch.setenv(variable, "1")
    show([LONG], stream)
    title, names, *rows = stream.getvalue().splitlines()
    assert (title == "a title") == (variable is not None)
    assert title.startswith("\x1b[1m") == names.startswith("\x1b[4m") == (variable is None)
    assert not any("\x1b" in row for row in rows)


def test_a_long_name_is_cut_in_the_middle() -> None:
    assert shorten("short") == "short"
    assert shorten("a" * 50 + "b" * 50, 21) == "a" * 10 + "…" + "b" * 10
