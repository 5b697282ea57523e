"""Values, names, keys and bytes that a reader of system files could take for something else."""

from __future__ import annotations

LONG = "9" * 4300
"""As many digits as a number may have."""

# fmt: off
GOOD_NUMBERS = [
    "1", "-1", "2", "3", "0.5", "-1.25", '"1/3"', "7", '"2/4"', '"-6/3"', "1e2", "1E+2", "1e-3",
    "-0.0e-0", '"0.50"', '"1e3"',
    '"-0"', '"0/5"', '"007/010"', '"01"', '"1E5"', '"1e+05"', "123456789012345678",
    "1234567890123456789", "-1234567890123456789",
    "100000000000000000000000000000", "0.1234567890123456789012345", '"\\u0031"',
    '"\\u0031/\\u0032"', "1e1000", "1e-1000", "1.0e1000",
    '"1/3000000000000000000000"', LONG, f'"{LONG}"', f'"1/{LONG}"', f'"-{LONG}/{LONG[1:]}"',
    f"0.{LONG[1:]}", "0e1000", '"1e-0000000000000000003"',
]
"""Numbers that both readers accept at the default limits."""

NASTY = [
    *GOOD_NUMBERS, "0", "null", "true", "false", '""', "[]", "{}", "[[]]", "[null]", "[0]",
    "[[0]]", '[""]', '[["0"]]', '{"": 0}', '"0"', '"x"', '"D"',
    '"+1"', '" 1"', '"1 "', '"1."', '".5"', '"0x1"', '"1_000"', '"\uff11"', '"\u0663"', '"1/0"',
    '"1/00"', '"0/0"', '"1/-2"', '"-1/-2"', '"1/2/3"', '"1.5/2"', '"1e5/3"',
    '"1/2e3"', '"nan"', '"inf"', '"NaN"', "NaN", "Infinity", "-Infinity", "1e1001", "1e-1001",
    '"1e1001"', "1e99999999999999999999", '"1e99999999999999999999"', '"1e"', '"--1"', '"-"',
    '"1\\n"', '"1\\u0000"', "01", "+1", ".5", "1.", "-", "1e", "1.0", "2.0", "0.0", "-0", '"1e 5"',
    '"- 1"', '"\u22121"', '"1,5"', "1,5", '"1/ 2"', '"1/+2"',
    LONG + "9", f'"{LONG}9"', f'"1/{LONG}9"', f"0.{LONG}", f"{LONG}e9", f"{LONG}e-9",
    f"{LONG}e-1000", f'"1e{LONG}"', '"1e' + "0" * 4299 + '5"', '"1e' + "0" * 4300 + '5"',
    '"' + "0" * 4300 + '1"', '"1e' + "0" * 9000 + '"', "1000000000000000000",
    "99999999999999999999", "-99999999999999999999", "1e3000",
    '{"shape": [0, 3], "entries": []}', '{"shape": [3, 0], "entries": []}',
    '{"shape": [0, 0], "entries": []}', '{"shape": [1, 1], "entries": []}',
    '{"shape": [2, 2], "entries": [[1, 1, 1]]}',
    '{"shape": [2, 2], "entries": [[1, 1, 1], [1, 1, 0]]}',
    '{"shape": [2, 2], "entries": [[-1, 0, 1]]}', '{"shape": [2, 2], "entries": [[0, 2, 1]]}',
    '{"shape": [2, 2], "entries": [[0.0, 0, 1]]}',
    '{"shape": [1, 1], "entries": {}}', '{"shape": [1, 1], "entries": null}',
    '{"shape": [1, true], "entries": []}', '{"shape": [1.0, 1], "entries": []}',
    '{"shape": [1], "entries": []}', '{"shape": [1, 1]}',
    '{"shape": [0, 1048576], "entries": []}', '{"shape": [0, 1048577], "entries": []}',
    '{"shape": [0, 100000000000000000000], "entries": []}', '{"shape": [-0, 1], "entries": []}',
    '{"shape": [1, 1], "entries": [[0, 0, false]]}', '{"shape": [1, 1], "entries": [[0, 0]]}',
    '{"shape": [1, 1], "entries": [[0, 0, 0, 0]]}', '{"shape": [1, 1], "entries": [], "x": 0}',
    '"continuous"', '"discrete"', '"Continuous"', '"mcexact-system/1"', '"mcexact-system/2"',
    '"1"', '"2"', '["1"]', '["1", "1"]', '["2", "1"]', '{"1": ["2"]}', '{"1": []}',
    '{"1": {"2": 1}}', '{"1": {"1": 0}}',
    '{"1": {"1": 1}}', '{"1": {"2": 0}}', '{"1": null}', '{"1": 0}', '{"1": ""}',
    '{"1": {"2": null}}', '{"1": {"2": false}}', '{"1": {"2": 1.0}}', '{"1": {"2": "1"}}',
    '{"1": {"2": -1}}',
    '"\\ud800"', '"\\udc00\\ud800"', '"\\ud83d\\ude00"', '"\\u202e"', '"\\u0000"', '"\\u200b"',
    '"\\u00ad"', '"\\u2028"', '"\\n"', '"\\t"', '"e\\u0301"', '"\\u00e9"',
    '"' + "a" * 256 + '"', '"' + "a" * 257 + '"', '"' + "a" * 10_000 + '"',
    '"' + "a" * 10_001 + '"', '"' + "7" * 4301 + '"', '"a' + "7" * 4301 + '"',
    '"' + "\\u0037" * 4301 + '"', "[" * 14 + "]" * 14, "[" * 40 + "]" * 40,
    '"a\x01b"', '"a\nb"', "tru", "nul", "'1'", '"\\x31"', '"\\u12"', "/**/1", "1 1", '"1" "2"',
    "{,}", "[,]", "[1,]", '{"a":1,}', '{"a" 1}', "{1: 1}",
]
"""What is put where something else belongs; some of it is right in some places."""

NAMES = [
    "1", "2", "3", "a", "b", "valve 1", "01", "\u00e9cluse", "e\u0301", "\u540d\u524d",
    "\U0001f600", 'say "a"', "back\\slash", "a, b", " ", "x" * 256,
    "null", "true", "A", "format", "B", "a/b", "~1", "\u01c5", "\ufffd", "0",
]
"""Names that both readers accept, no two of them equal."""

TEXTS = [
    "", "two tanks", "line\nfeed\tand tab", "J. Control 12 (1999), 345", "x" * 10_000,
    "\u00fcber \u2260", "1234567890" * 20,
]
"""Texts that both readers accept as a name or source of a system."""

KEYS = [
    '"format"', '"time"', '"A"', '"channels"', '"name"', '"source"', '"sample_time"',
    '"neighbors"', '"delays"', '"D"', '"B"', '"C"', '"shape"', '"entries"', '"K"', '"E"', '""',
    '"a"', '"Time"',
    '"\\u0044"', '"D "', '"\\u0000"', '"description"', '"comment"', '"$schema"', '"notes"', '"x0"',
    '"names"', '"1"', '"2"',
]
"""Keys that belong somewhere, or nowhere."""

BYTES = [
    b"\xef\xbb\xbf", b"\xff", b"\x00", b" ", b"\n", b"x", b"{}", b"null", b",", b":", b"]", b"}",
    b"[", b"{", b'"', b"\\", b"\xc3", b"\xe2\x80\xa8", b"\xc2\xa0", b"\x0b",
    b"\xed\xa0\x80", b"1", b"0", b"-", b".", b"e", b"//", b"#",
]
"""Bytes that are put into a text."""

ENCODINGS = ["utf-16", "utf-16-le", "utf-32", "utf-8-sig", "latin-1", "utf-7", "cp1252"]
