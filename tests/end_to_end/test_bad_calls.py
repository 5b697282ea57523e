"""Calls that cannot be meant end with an error of this package that says where and what.

The names in front are those of the catalogue of bad inputs.
"""

import json
import pickle
import signal
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from pathlib import Path
from typing import Any

import control
import networkx
import numpy as np
import pytest
import sympy

from mcexact import MultiChannelSystem, NeighborGraph, fixed_spectrum
from mcexact.errors import FloatRefused, InputError, LimitReached, McexactError, UsageError
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model import gallery
from mcexact.model.statespace import from_statespace
from mcexact.sweeps.run import sweep
from tests import effort
from tests.effort import PATIENCE
from tests.end_to_end.command_line import MCEXACT, interruptible

ONE = [[[1]]]
X = Polynomial.of(0, 1)


class LyingList(list[Any]):
    """A list whose length is not what it holds."""

    def __len__(self) -> int:
        return 5


def system(A: Any, B: Any = ONE, C: Any = ONE, **rest: Any) -> MultiChannelSystem:
    return MultiChannelSystem(A, B, C, **rest)


def graph(*edges: tuple[Any, ...]) -> NeighborGraph:
    return NeighborGraph.from_networkx(networkx.DiGraph(list(edges)))


CALLS: dict[str, tuple[Callable[[], Any], type[McexactError], tuple[str, ...]]] = {
    "B163 a node that is True": (
        lambda: graph((True, 2)),
        InputError,
        ("names or integers as nodes", "True"),
    ),
    "B163 a node that is a float": (lambda: graph((1.0, 2)), InputError, ("1.0",)),
    "B165 an undirected graph": (
        lambda: NeighborGraph.from_networkx(networkx.Graph([("0", "1")])),
        InputError,
        ("directed", "to_directed()"),
    ),
    "B167 an edge with a float as weight": (
        lambda: graph(("0", "1", {"weight": 0.1})),
        FloatRefused,
        ("edge '0' -> '1'", "0.1"),
    ),
    "B167 an edge with a float as delay": (
        lambda: graph(("0", "1", {"delay": 0.1})),
        FloatRefused,
        ("delay", "0.1"),
    ),
    "B171 floats, as other libraries hold them": (
        lambda: system(np.array([[0.5]])),
        FloatRefused,
        ("A", "float64", "from_float(A, B, C)"),
    ),
    "B171 a rounding that there is not": (
        lambda: from_statespace(control.ss(0.5, 1, 1, 0), [(0, 0)], rounding=None),
        InputError,
        ("rounding", "decimal", "dyadic"),
    ),
    "B189 a cluster's client in place of its executor": (
        lambda: next(sweep([], executor=object())),  # type: ignore[arg-type]
        UsageError,
        ("concurrent.futures.Executor", "client.get_executor()"),
    ),
    "B171 a float": (lambda: system([[0.5]]), FloatRefused, ("A[0][0]", "from_float")),
    "B171 a complex number": (lambda: system([[1j]]), InputError, ("A[0][0]",)),
    "B173 a symbol": (
        lambda: system(sympy.Matrix([[sympy.Symbol("k")]])),
        InputError,
        ("A[0][0]", "'k'", "ParametricSystem"),
    ),
    "B173 a symbolic float": (
        lambda: system(sympy.Matrix([[sympy.Float(0.5)]])),
        FloatRefused,
        ("A[0][0]",),
    ),
    "B175 text as a matrix": (lambda: system("12;34"), InputError, ("A", "list of rows", "string")),
    "B177 an array of three dimensions": (
        lambda: system(np.zeros((1, 1, 1), dtype=int)),
        InputError,
        ("A", "3 dimensions"),
    ),
    "B177 no matrix": (lambda: system(None), InputError, ("A", "NoneType")),
    "B179 a negative size": (lambda: Matrix.zeros(-1, 3), InputError, ("rows", "-1")),
    "B179 an absurd size": (
        lambda: Matrix.zeros(10**9, 10**9),
        LimitReached,
        ("1000000000 × 1000000000",),
    ),
    "B181 an absurd power of a polynomial": (
        lambda: X ** (10**12),
        LimitReached,
        ("1000000000000",),
    ),
    "B181 an absurd power of a matrix": (
        lambda: Matrix.from_rows([[2]]).power(10**12),
        LimitReached,
        ("1000000000000",),
    ),
    "B181 a negative power": (lambda: X**-1, InputError, ("at least 0", "-1")),
    "B181 an absurd exponent": (lambda: system([["1e999999999"]]), InputError, ("exponent",)),
    "D301 a Boolean": (lambda: system([[True]]), InputError, ("A[0][0]", "True")),
    "D302 not a number": (
        lambda: MultiChannelSystem.from_float(
            [[float("nan")]], [[[1.0]]], [[[1.0]]], rounding="decimal"
        ),
        InputError,
        ("A[0][0]", "nan"),
    ),
    "D303 no channels": (lambda: system([[1]], [], []), InputError, ("at least one channel",)),
    "D304 more B than C": (lambda: system([[1]], ONE * 2, ONE), InputError, ("C", "2", "1")),
    "D305 B with too few rows": (
        lambda: system([[1, 0], [0, 1]], [[[1]]], [[[1, 1]]]),
        InputError,
        ("B", "expected 2 rows, found 1"),
    ),
    "D306 a time domain that does not exist": (
        lambda: system([[1]], time="hybrid"),
        InputError,
        ("time", "continuous", "'hybrid'"),
    ),
    "D307 one name twice": (
        lambda: system([[1]], ONE * 2, ONE * 2, names=["a", "a"]),
        InputError,
        ("names[1]", "'a'"),
    ),
    "D308 a graph of another library": (
        lambda: system([[1]], neighbors=networkx.DiGraph()),
        InputError,
        ("channels as nodes", "'1'"),
    ),
    "D309 a system that is not in the gallery": (
        lambda: gallery.load("hiden-triple-mode"),
        UsageError,
        ("hidden-triple-mode",),
    ),
}


@pytest.mark.parametrize("name", CALLS)
def test_a_call_that_cannot_be_meant_says_where_and_what(name: str) -> None:
    call, kind, texts = CALLS[name]
    with effort.at_most(20_000), pytest.raises(McexactError) as caught:
        call()
    assert isinstance(caught.value, kind)
    for text in texts:
        assert text in str(caught.value)
    assert "\n" not in str(caught.value)


def test_b169_integer_arrays_are_taken_as_they_are() -> None:
    assert system(np.array([[2**62]], dtype=np.int64)).A[0, 0] == 2**62


def test_b177_an_object_whose_length_lies_is_copied_first() -> None:
    assert system(LyingList([[1]])).n == 1


def test_b183_systems_and_matrices_can_be_sent_to_other_processes() -> None:
    made = system([[Fraction(1, 3)]])
    assert made.A @ made.A == Matrix.from_rows([["1/9"]])  # the arithmetic has been used
    assert pickle.loads(pickle.dumps(made)) == made


def test_b191_threads_can_share_one_system() -> None:
    plant = gallery.load("hidden-triple-mode")
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(fixed_spectrum, [plant] * 8))
    assert all(each == found[0] for each in found)


@pytest.mark.skipif(sys.platform == "win32", reason="there is no such signal")
def test_b187_an_interrupt_during_an_analysis_ends_it_with_130_and_leaves_nothing_half_done(
    tmp_path: Path,
) -> None:
    n, dice = 800, np.random.default_rng(1)
    document = {
        "format": "mcexact-system/1",
        "time": "continuous",
        "A": dice.integers(-9, 10, (n, n)).tolist(),
        "channels": [{"name": name, "B": [[1]] * n, "C": [[1] * n]} for name in ("1", "2")],
    }
    file = tmp_path / "large.json"
    file.write_text(json.dumps(document), encoding="utf-8")
    with subprocess.Popen(
        [*MCEXACT, "analyze", str(file), "--certificates", str(tmp_path)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        preexec_fn=interruptible,
    ) as process:
        if process.stderr is None:
            raise RuntimeError("no standard error")
        said = process.stderr.readline()
        assert said.decode().startswith("mcexact: analyzing ") and process.poll() is None
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=PATIENCE)
        assert process.returncode == 130 and b"Traceback" not in err
    # What was decided before is shown, and nothing is begun that would not be finished.
    assert not out or b"the work was interrupted" in out
    assert not [path.name for path in tmp_path.iterdir() if path.name.startswith(".")]
