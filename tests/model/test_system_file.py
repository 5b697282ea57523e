"""System files: what is written can be read, and what is wrong is named with its place."""

import base64
import io
import json
import os
import random
import stat
import sys
import threading
import time
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
import scipy.sparse
from hypothesis import given
from hypothesis import strategies as st

from mcexact import testing
from mcexact.analysis.controllability import joint_controllability
from mcexact.answer import protocol
from mcexact.checker.core.reading import Limits as CheckerLimits
from mcexact.checker.kinds import check_document
from mcexact.derived.constructions import extended_system
from mcexact.errors import FloatRefused, InputError, NotWritten
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational import Limits
from mcexact.model import gallery
from mcexact.model import text as json_text
from mcexact.model.entries import canonical_matrix_text, matrix_json, number_json, read_matrix
from mcexact.model.files import load_system, save_system
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import read_system, system_text
from mcexact.model.text import canonical, numbers_of_any_length, write_text
from tests.wording import refusal


def document(**changes):
    """A small system file as an object, with some keys changed; None removes one."""
    base = {
        "format": "mcexact-system/1",
        "time": "discrete",
        "A": [[1, 0], ["1/2", 0]],
        "channels": [
            {"name": "u1", "B": [[1], [0]], "C": [[1, 0]]},
            {"name": "u2", "B": [[0], [1]], "C": [[0, 1]]},
        ],
        "neighbors": {"u1": ["u2"], "u2": []},
        "delays": {"u1": {"u2": 1}},
    }
    merged = {**base, **changes}
    return {key: value for key, value in merged.items() if value is not None}


def channel(**changes):
    """The channels of `document`, the first one changed."""
    first = {"name": "u1", "B": [[1], [0]], "C": [[1, 0]], **changes}
    return [first, {"name": "u2", "B": [[0], [1]], "C": [[0, 1]]}]


def refused(text, message):
    """Refuse a text with one message."""
    with pytest.raises(InputError, match=message) as caught:
        read_system(text if isinstance(text, (str, bytes)) else json.dumps(text))
    assert "\n" not in str(caught.value)


names = st.text(min_size=1, max_size=5).filter(
    lambda text: all(c.isprintable() and c != "\xad" for c in text)
)


@given(testing.systems_on_graphs(testing.systems(), longest_delay=3))
def test_what_is_written_is_read_back(drawn):
    system = drawn.system
    assert read_system(system_text(system)) == system
    assert read_system(system_text(system)).digest() == system.digest()


@given(testing.jointly_controllable_systems(denominators=True, time="discrete"), names, names)
def test_names_sources_and_sample_times_are_carried(drawn, name, source):
    found = drawn.system
    system = MultiChannelSystem(
        found.A,
        [channel.B for channel in found.channels],
        [channel.C for channel in found.channels],
        time="discrete",
        sample_time="1/30",
        name=name,
        source=source,
    )
    copy = read_system(system_text(system))
    assert (copy.name, copy.source, copy.sample_time) == (name, source, Fraction(1, 30))
    assert copy == system and copy.digest() == found.digest()


@given(testing.systems(), st.randoms(use_true_random=False))
def test_the_digest_does_not_depend_on_how_the_file_is_written(drawn, rng):
    system = drawn.system
    plain = json.loads(system_text(system))

    def rewritten(value):
        if isinstance(value, bool) or value is None:
            return value
        if isinstance(value, int):
            return rng.choice([value, str(value), f"{3 * value}/3", f"{value}.0", f"{value}0e-1"])
        if isinstance(value, list):
            return [rewritten(item) for item in value]
        if isinstance(value, dict):
            if set(value) == {"shape", "entries"}:
                return value
            items = list(value.items())
            rng.shuffle(items)
            return {key: rewritten(item) for key, item in items}
        return value

    plain = rewritten(plain)
    assert read_system(json.dumps(plain, indent=rng.choice([None, 3]))).digest() == system.digest()


def test_everything_that_matters_changes_the_digest():
    base = read_system(json.dumps(document())).digest()
    changes: list[dict[str, Any]] = [
        {"time": "continuous"},
        {"A": [[1, 0], ["1/3", 0]]},
        {"channels": channel(name="v1"), "neighbors": None, "delays": None},
        {"channels": channel()[::-1]},
        {"neighbors": None, "delays": None},
        {"neighbors": {"u1": ["u2"], "u2": ["u1"]}},
        {"delays": {"u1": {"u2": 2}}},
    ]
    digests = {read_system(json.dumps(document(**change))).digest() for change in changes}
    assert len(digests) == len(changes) and base not in digests
    same: list[dict[str, Any]]
    same = [{"name": "a", "source": "b", "sample_time": 1}, {"delays": {"u1": {"u2": 1}, "u2": {}}}]
    for change in same:
        assert read_system(json.dumps(document(**change))).digest() == base


def test_the_canonical_document_is_the_one_of_the_certificate_format():
    system = read_system(json.dumps(document(name="x", sample_time=1)))
    assert system.canonical_document() == {
        "time": "discrete",
        "A": [[1, 0], ["1/2", 0]],
        "channels": [
            {"name": "u1", "B": [[1], [0]], "C": [[1, 0]]},
            {"name": "u2", "B": [[0], [1]], "C": [[0, 1]]},
        ],
        "neighbors": {"u1": ["u2"], "u2": []},
        "delays": {"u1": {"u2": 1}},
    }
    assert extended_system(system, [1, 1]).canonical_document() == system.canonical_document()
    assert extended_system(system, [1, 1]).digest() == system.digest()


def test_matrices_without_rows_say_their_shape():
    system = MultiChannelSystem([[1]], [[[1]]], [[]])
    assert system.canonical_document()["channels"][0]["C"] == {"shape": [0, 1], "entries": []}
    system = MultiChannelSystem([], [read_matrix({"shape": [0, 2], "entries": []}, "B")], [[]])
    text = system_text(system)
    assert read_system(text).p(0) == 2 and system.canonical_document()["A"] == []


def test_every_gallery_file_survives_reading_and_writing():
    for name in gallery.names():
        system = gallery.load(name)
        assert system.source and read_system(system_text(system)) == system
        assert gallery.expected(name)["jointly_controllable"] in (True, False)


def test_decimals_are_exact_as_typed():
    text = json.dumps(document(A=[["PLACE", 0], [0, 0]])).replace('"PLACE"', "-0.1e1")
    assert read_system(text).A[0, 0] == -1
    text = json.dumps(document(A=[["PLACE", 0], [0, 0]])).replace('"PLACE"', "0.1")
    assert read_system(text).A[0, 0] == Fraction(1, 10)


def test_a_sparse_matrix_is_the_dense_one():
    sparse = {"shape": [2, 2], "entries": [[1, 0, "1/2"], [0, 0, 1.0]]}
    assert read_system(json.dumps(document(A=sparse))) == read_system(json.dumps(document()))


def test_long_integers_are_read_and_written():
    rng = random.Random(0)
    digits = str(rng.randrange(10**4299, 10**4300))
    system = read_system(json.dumps(document(A=[[digits, 0], [0, f"1/{digits}"]])))
    assert system.A[0, 0] == int(digits) and read_system(system_text(system)) == system
    longer = Fraction(1, 10**5000 + 1)
    assert number_json(longer) == "1/1" + "0" * 4999 + "1"


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "found an empty file"),
        (b"  \n", "found an empty file"),
        (b"\xef\xbb\xbf\xef\xbb\xbf{}", "not JSON: .* BOM"),
        (base64.b64decode("iVBORw0KGgo="), "not UTF-8 text: byte 0 is 0x89"),
        (json.dumps(document())[:200], "not JSON: .* at line 1, column"),
        (json.dumps(document()).encode() + b"\0", "not JSON: Extra data"),
        ('{"format":"mcexact-system/1",}', "not JSON: .*leave out the comma before the closing"),
        ('{"A": [[1, 2, ]]}', "not JSON: .*leave out the comma before the closing"),
        ('{"A": [[-1/2]]}', 'not JSON: .*a quotient is a text, "1/3", and there are no comments'),
        (
            '{"format": "mcexact-system/1", "agents": []}',
            "unknown key 'agents'; known are 'format', .*'channels'",
        ),
        ("[]", 'expected a JSON object with "format": "mcexact-system/1", found a list'),
        ("3", "found a number"),
        ("null", "found null"),
        ('"a"', "found the string 'a'"),
        ("[" * 100_000 + "]" * 100_000, r"at most 16 nested levels \(Limits.depth\), found more"),
        ("[" * 17 + "]" * 17, "at most 16 nested levels"),
        ('{"a": {"b": 1, "b": 2}}', "the key 'b' is given twice"),
        ("A = [[0.1]]", "not JSON"),
        ('{"format": "mcexact-system/1", "a\\ud800": 1}', "unknown key 'a\\\\ud800'"),
    ],
)
def test_bytes_that_are_no_json_object_are_refused(data, message):
    refused(data, message)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"format": None}, "the key 'format' is missing"),
        ({"format": "mcexact-system/2"}, 'format: expected "mcexact-system/1", found version'),
        (
            {"format": "mcexact-certificate/1"},
            "format: expected a system file, found a certificate",
        ),
        ({"format": "mcexact-controller/1"}, "expected a system file, found a controller file"),
        ({"format": "x"}, "format: expected \"mcexact-system/1\", found 'x'"),
        ({"format": 1}, "format: .* found a value of type int"),
        ({"chanels": []}, r"unknown key 'chanels' \(did you mean 'channels'\?\)"),
        ({"zzz": []}, "unknown key 'zzz'; known are 'format', .*'parameters'"),
        ({"paramters": {}}, r"unknown key 'paramters' \(did you mean 'parameters'\?\)"),
        ({"time": None}, "the key 'time' is missing"),
        ({"time": "sampled"}, 'time: expected "continuous" or "discrete", found \'sampled\''),
        ({"time": 3}, 'time: expected "continuous" or "discrete"'),
        ({"A": [[1, 0]]}, "A: expected a square matrix, found 1 × 2"),
        ({"A": [[1, 0], [1]]}, r"A\[1\]: expected 2 entries as in row 0, found 1"),
        ({"A": [1, 2]}, r"A\[0\]: expected a row as a list, found a number; write a column"),
        ({"A": "12;34"}, "A: expected a list, found the string '12;34'"),
        ({"A": [[None, 0], [0, 0]]}, r"A\[0\]\[0\]: expected a number, found null"),
        ({"A": [[True, 0], [0, 0]]}, r"A\[0\]\[0\]: expected a number, found true"),
        ({"A": [[[1], 0], [0, 0]]}, r"A\[0\]\[0\]: expected a number, found a list"),
        ({"A": [["1 / 2", 0], [0, 0]]}, r"A\[0\]\[0\]: expected an integer, a decimal"),
        ({"A": [["1/0", 0], [0, 0]]}, r"A\[0\]\[0\]: the denominator is zero"),
        ({"A": [["1e1001", 0], [0, 0]]}, r"A\[0\]\[0\]: expected an exponent of at most 1000"),
        ({"A": [["9" * 4301, 0], [0, 0]]}, r"A\[0\]\[0\]: the number has more than 4300 digits"),
        ({"A": [["9" * 4300 + "e9", 0], [0, 0]]}, "at most 4300 digits when written out"),
        ({"A": [[float("nan"), 0], [0, 0]]}, r"A\[0\]\[0\]: .* found 'NaN'"),
        ({"A": [[float("inf"), 0], [0, 0]]}, r"A\[0\]\[0\]: .* found 'Infinity'"),
        ({"A": {"shape": [2], "entries": []}}, r"A.shape: expected \[rows, columns\], found 1"),
        ({"A": {"shape": [2, -1], "entries": []}}, r"A.shape\[1\]: expected an integer >= 0"),
        ({"A": {"shape": [2, 2.5], "entries": []}}, r"A.shape\[1\]: .* found 2.5"),
        (
            {"A": {"shape": [10**9, 10**9], "entries": []}},
            "at most 1048576 rows and columns in a sparse matrix",
        ),
        ({"A": {"shape": [2, 2]}}, "A: the key 'entries' is missing"),
        ({"A": {"shape": [2, 2], "entries": [[0, 0]]}}, r"A.entries\[0\]: expected \[row, column"),
        ({"A": {"shape": [2, 2], "entries": [[0, 2, 1]]}}, "a position inside 2 × 2"),
        ({"A": {"shape": [2, 2], "entries": [[0, 1, 1]] * 2}}, r"\[0, 1\] is listed twice"),
        ({"A": {"shape": [2, 2], "entries": [[0, 1, "x"]]}}, r"A.entries\[0\]\[2\]: expected"),
        ({"channels": []}, "channels: expected at least one channel, found none"),
        ({"channels": {}}, "channels: expected a list, found an object"),
        ({"channels": [3]}, r"channels\[0\]: expected a JSON object, found a number"),
        ({"channels": channel(B=[[1]])}, r"channels\[0\].B: expected 2 rows, found 1"),
        (
            {"channels": channel(B={"shape": [3, 1], "entries": []})},
            r"channels\[0\].B: expected 2 rows, found 3",
        ),
        ({"channels": channel(C=[[1]])}, r"channels\[0\].C: expected 2 columns, found 1"),
        ({"channels": channel(D=[[1, 1]])}, r"channels\[0\].D: expected 1 column, found 2"),
        ({"D": [[0, "1/2"]]}, "D: expected 2 rows, found 1"),
        ({"channels": channel(D=[[1]]), "D": [[0, 1], [0, 0]]}, "D: .* its channels, found both"),
        ({"channels": channel(K=1)}, r"channels\[0\]: unknown key 'K'"),
        ({"channels": channel(name="u2")}, r"channels\[1\].name: .* also channels\[0\].name"),
        ({"channels": channel(name="a\0b")}, r"channels\[0\].name: remove the character U\+0000"),
        ({"channels": channel(name="u\u202e1")}, r"remove the character U\+202E"),
        ({"channels": channel(name="")}, r"channels\[0\].name: expected a name"),
        ({"channels": channel(name=1)}, r"channels\[0\].name: expected a name as a string"),
        ({"neighbors": None}, "delays: delays need links: the key 'neighbors' is missing"),
        ({"neighbors": []}, "neighbors: expected an object keyed by agents, found a list"),
        ({"neighbors": {"u3": []}}, r"neighbors: there is no agent 'u3'"),
        ({"neighbors": {"u1": "u2"}}, r"neighbors\['u1'\]: expected a list"),
        ({"delays": {"u3": {}}}, r"delays: there is no agent 'u3'"),
        ({"delays": {"u2": {"u1": 1}}}, "there is no such link"),
        ({"delays": {"u1": {"u2": -1}}}, r"delays\['u1'\]\['u2'\]: expected an integer >= 0"),
        ({"delays": {"u1": {"u2": 0.5}}}, r"delays\['u1'\]\['u2'\]: .* found 0.5"),
        ({"delays": {"u1": [1]}}, r"delays\['u1'\]: expected an object keyed by agents"),
        ({"neighbors": {"u1": [2.5]}}, r"neighbors\['u1'\]\[0\]: expected a name as a string"),
        ({"channels": channel(name=1.5)}, r"channels\[0\].name: expected a name as a string"),
        ({"channels": channel(D=None)}, r"channels\[0\].D: expected a list, found null"),
        ({"name": 1.5}, "name: expected a string, found a number"),
        ({"source": "7" * 4301}, r"expected at most 4300 digits in a row \(Limits.digits\)"),
        (
            {"A": [["1e" + "0" * 4301, 0], [0, 0]]},
            r"A\[0\]\[0\]: the number has more than 4300 dig",
        ),
        ({"sample_time": "0"}, "sample_time: expected a number > 0"),
        ({"sample_time": 1, "time": "continuous"}, "sample_time: only discrete time"),
        ({"name": 3}, "name: expected a string"),
        ({"source": "a\u202eb"}, r"source: remove the character U\+202E"),
    ],
)
def test_a_malformed_system_is_refused_with_its_place(changes, message):
    refused(document(**changes), message)


def test_a_feedthrough_of_zeros_and_missing_names_are_accepted():
    channels = channel(D=[[0]])
    del channels[1]["name"]
    system = read_system(json.dumps(document(channels=channels, neighbors=None, delays=None)))
    assert system.names == ("u1", "2")


def test_files_are_loaded_with_their_name_in_front_of_the_place(tmp_path):
    path = tmp_path / "plant.json"
    path.write_text(json.dumps(document(channels=channel(B=[[1]]))))
    with pytest.raises(InputError) as caught:
        load_system(path)
    assert str(caught.value) == f"{path}: channels[0].B: expected 2 rows, found 1"


def test_missing_unreadable_and_large_files_are_refused(tmp_path):
    with refusal(InputError):
        load_system(tmp_path / "nothing.json")
    with pytest.raises(InputError, match="cannot be read: Is a directory"):
        load_system(tmp_path)
    with pytest.raises(InputError, match="is not a file name"):
        load_system("a\0b")
    large = tmp_path / "large.json"
    with large.open("wb") as stream:
        stream.truncate(2**40)
    with pytest.raises(InputError, match=r"at most 67108864 bytes \(Limits.bytes\), found more"):
        load_system(large)
    with pytest.raises(InputError, match="at most 10 bytes"):
        read_system(b" " * 11, limits=Limits(bytes=10))
    with pytest.raises(InputError, match="at most 10 bytes"):
        load_system("/dev/zero", limits=Limits(bytes=10))


def test_a_minus_sign_reads_the_standard_input(monkeypatch):
    text = io.TextIOWrapper(io.BytesIO(json.dumps(document()).encode()))
    monkeypatch.setattr(sys, "stdin", text)
    assert load_system("-").n == 2
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(b"{}")))
    with pytest.raises(InputError, match="standard input: the key 'format' is missing"):
        load_system("-")


def test_limits_can_be_raised():
    digits = "9" * 5000
    text = json.dumps(document(A=[[digits, 0], [0, 0]]))
    assert read_system(text, limits=Limits(digits=5000)).A[0, 0] == 10**5000 - 1


def test_a_file_is_written_through_a_link_to_the_input_and_keeps_its_mode(tmp_path):
    path, link = tmp_path / "plant.json", tmp_path / "link.json"
    save_system(read_system(json.dumps(document())), path)
    path.chmod(0o640)
    link.symlink_to(path)
    save_system(load_system(link).with_neighbors(NeighborGraph.empty(("u1", "u2"))), link)
    assert link.is_symlink() and load_system(path).neighbors.edges() == ()
    assert stat.S_IMODE(path.stat().st_mode) == 0o640
    assert sorted(os.listdir(tmp_path)) == ["link.json", "plant.json"]


def test_nothing_is_left_behind_when_writing_fails(tmp_path, monkeypatch):
    path = tmp_path / "plant.json"
    path.write_text("before")

    def failing(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", failing)
    with refusal(NotWritten):
        write_text(path, "after")
    assert path.read_text() == "before" and os.listdir(tmp_path) == ["plant.json"]


def test_writing_into_a_missing_folder_is_refused(tmp_path):
    with refusal(NotWritten):
        write_text(tmp_path / "missing" / "plant.json", "{}")


def test_a_name_as_long_as_the_file_system_allows_can_be_written(tmp_path):
    path = tmp_path / ("界" * 83 + ".json")
    write_text(path, "{}")
    assert path.read_text() == "{}"


def test_what_no_file_can_be_called_is_refused():
    with pytest.raises(InputError, match=r"is not a file name: .*embedded null"):
        write_text("a\0b", "{}")


def test_what_is_no_regular_file_is_written_to_as_it_is():
    write_text("/dev/null", "{}")
    assert not os.path.isfile("/dev/null")


@given(testing.jointly_controllable_systems(denominators=True))
def test_a_matrix_read_from_its_own_json_is_the_same(drawn):
    A = drawn.system.A
    plain = json.loads(json.dumps(matrix_json(A)))
    assert read_matrix(plain, "A") == A


@pytest.mark.parametrize(
    "rows",
    [
        [],
        [[]] * 3,
        [[0, -1, 12], [2**63 - 1, -(2**63), 7]],
        [[5], [-6], [70]],
        [["1/2", "-4/6", 3], ["0", "8/2", "-1/1"]],
        [[2**63, 1]],
        [[-(10**5000), "1/3"]],
        [[Fraction(10**5000, 7)]],
    ],
)
def test_the_canonical_text_of_a_matrix_is_the_json_of_its_reduced_entries(rows):
    M = Matrix.from_rows([[Fraction(entry) for entry in row] for row in rows])
    with numbers_of_any_length():
        table = [[int(x) if x.denominator == 1 else str(x) for x in row] for row in M.rows()]
        assert canonical_matrix_text(M) == canonical(table)
        assert canonical_matrix_text(M.T.T) == canonical_matrix_text(M)


def test_the_canonical_text_of_a_system_is_the_json_of_its_document():
    for name in gallery.names():
        system = gallery.load(name)
        assert system.canonical_text() == canonical(system.canonical_document())
    named = MultiChannelSystem([[1]], [[[1]]], [[[1]]], names=['ä "b"\\'])
    assert named.canonical_text() == canonical(named.canonical_document())


def test_an_unknown_gallery_system_is_refused():
    with refusal(ValueError):
        gallery.load("hiden-triple-mode")


def test_certificates_about_plants_with_very_long_integers_are_canonical() -> None:
    plant = MultiChannelSystem([[10**6000]], [[[1]]], [[[1]]])
    text = protocol.encode(joint_controllability(plant)).encode("ascii")
    assert check_document(text, limits=CheckerLimits(digits=10**4)).verdict == "VALID"


def test_large_sparse_systems_stay_sparse_in_files():
    n = 3000
    A = scipy.sparse.coo_array((np.arange(1, n), (np.arange(1, n), np.arange(n - 1))), shape=(n, n))
    B = scipy.sparse.csr_array(([5], ([0], [0])), shape=(n, 1))
    C = [["1/3"] + [0] * (n - 1)]
    system = MultiChannelSystem(A, [B, B], [C, B.T], names=["first", "last"])
    again = read_system(system_text(system))
    for each in (system, again):
        assert each.A.is_sparse
        assert each.A[1, 0] == 1
        assert each.B(0).is_sparse
        assert each.C(0)[0, 0] * 3 == 1
    assert again == system
    text = again.canonical_text()
    assert text.startswith('{"A":{"entries":[[1,0,1],[2,1,2],')
    assert '"C":{"entries":[[0,0,"1/3"]],"shape":[1,3000]},"name":"first"' in text
    assert again.digest() == "23c1fad59f8e329bb292e5eb48fcec12671f655c45332f9eb8a80a24c79c1fb3"


def test_sparse_arrays_of_floats_and_of_a_wrong_shape_are_refused():
    eye = scipy.sparse.csr_array(np.eye(3))
    with refusal(FloatRefused, where="A"):
        MultiChannelSystem(eye, [[[1]] * 3], [[[1] * 3]])
    system = MultiChannelSystem.from_float(eye, [[[1]] * 3], [[[1] * 3]], rounding="decimal")
    assert system.A == Matrix.identity(3)
    with pytest.raises(InputError, match=r"B\[0\]: expected 3 rows, found 2"):
        MultiChannelSystem(eye.astype(int), [eye.astype(int).tocsr()[:2]], [[[1] * 3]])  # type: ignore[misc]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes")
def test_a_pipe_is_read_when_somebody_writes_to_it(tmp_path, monkeypatch):
    path, text = tmp_path / "pipe.json", json.dumps(document())
    os.mkfifo(path)
    for first, second in ((text, ""), (text[:50], text[50:])):

        def write(first=first, second=second):
            with path.open("w") as stream:
                time.sleep(0.05)
                print(first, end="", file=stream, flush=True)
                time.sleep(0.05)
                stream.write(second)

        writer = threading.Thread(target=write)
        writer.start()
        assert load_system(path) == read_system(text)
        writer.join()
    monkeypatch.setattr(json_text, "WAIT_FOR_WRITER", 0.05)
    with refusal(InputError):
        load_system(path)
    writer = threading.Thread(target=path.write_text, args=(text,))
    writer.start()
    with pytest.raises(InputError, match="at most 20 bytes"):
        load_system(path, limits=Limits(bytes=20))
    writer.join()
