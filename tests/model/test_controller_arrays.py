"""Controllers in files of MATLAB and archives of numpy."""

from __future__ import annotations

import io
import json
import random
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io

from mcexact.errors import InputError, RoundingWarning
from mcexact.exact.matrix import Matrix
from mcexact.model.controller import (
    AgentProgram,
    Controller,
    LinearMap,
    load_controller,
    read_controller,
    save_controller,
)
from tests.cli.calling import call
from tests.wording import refusal


def drawn(seed: int, denominators: tuple[int, ...] = (1, 2, 8)) -> Controller:
    """Three agents that use each other's signals, with delays of one's own."""
    rng = random.Random(seed)
    shared, private, q = (2, 0, 1), (1, 2, 0), (1, 2, 1)

    def M(r: int, c: int) -> Matrix:
        rows = [
            [Fraction(rng.randint(-9, 9), rng.choice(denominators)) for _ in range(c)]
            for _ in range(r)
        ]
        return Matrix.from_rows(rows, ncols=c)

    def program(i: int, rows: int) -> LinearMap:
        heard = [j for j in range(3) if rng.random() < 0.7]
        return LinearMap(
            {j: M(rows, q[j]) for j in heard},
            {j: M(rows, shared[j]) for j in heard},
            M(rows, private[i]),
            M(rows, q[i]) if rng.random() < 0.5 else None,
        ).without_zeros()

    agents = tuple(
        AgentProgram(
            name,
            shared[i],
            private[i],
            program(i, shared[i]),
            program(i, private[i]),
            program(i, 2),
            {0: 2, 1: 1} if i == 0 else {},
        )
        for i, name in enumerate(("pump", "Ventil 2", "3"))
    )
    return Controller("discrete", "ab" * 32, agents)


def same(a: Controller, b: Controller) -> bool:
    """Whether two controllers compute the same; matrices of zeros say nothing."""
    return a.to_dict() == b.to_dict()


@pytest.mark.parametrize("kind", ["mat", "npz", "json"])
@pytest.mark.parametrize("seed", range(4))
def test_a_controller_comes_back(seed: int, kind: str, tmp_path: Path) -> None:
    controller, path = drawn(seed), tmp_path / f"controller.{kind}"
    save_controller(controller, path)
    assert same(load_controller(path), controller)
    first = path.read_bytes()
    save_controller(controller, path)
    assert path.read_bytes() == first


def test_an_archive_has_all_numbers_exactly(tmp_path: Path) -> None:
    controller, path = drawn(5, (1, 3, 7, 10**30)), tmp_path / "controller.npz"
    save_controller(controller, path)
    assert same(load_controller(path), controller)


def test_floats_are_written_if_they_come_back_or_the_nearest_are_asked_for(tmp_path: Path) -> None:
    controller = drawn(5, (1, 3, 7))
    for kind in ("mat", "npz"):
        path = tmp_path / f"controller.{kind}"
        save_controller(controller, path, rounding="simplest")
        assert same(load_controller(path), controller)
        save_controller(controller, path, nearest=True)
        read = load_controller(path)
        assert not same(read, controller)
        pairs = zip(read.matrices(), controller.matrices(), strict=True)
        for M, N in pairs:
            for a, b in zip(M.rows(), N.rows(), strict=True):
                assert a == tuple(Fraction(float(x)) for x in b)
    with refusal(InputError):
        save_controller(controller, tmp_path / "controller.mat")
    with pytest.raises(InputError, match=r"floats are for \.mat and \.npz"):
        save_controller(controller, tmp_path / "controller.json", nearest=True)


def by_hand() -> dict[str, Any]:
    """A controller as a person writes it: z_1 integrates y_1, and agent 2 uses z of nobody."""
    return {
        "format": "mcexact-controller/1",
        "time": "discrete",
        "shared": np.array([[0, 1]]),
        "private": np.array([[1, 0]]),
        "z_1_z": np.array([[1.0]]),
        "z_1_y_1": np.array([[0.1]]),
        "u_1_z": np.array([[-1 / 3]]),
        "x_2_y_2": np.array([[1.0]]),
        "u_2_x_2": np.array([[0.25]]),
        "u_2_r": np.array([[2.0]]),
    }


EXPECTED = Controller(
    "discrete",
    "",
    (
        AgentProgram(
            "a",
            0,
            1,
            private_update=LinearMap({0: Matrix.from_rows([["1/10"]])}, private=Matrix.identity(1)),
            input=LinearMap(private=Matrix.from_rows([["-1/3"]])),
        ),
        AgentProgram(
            "b",
            1,
            0,
            shared_update=LinearMap({1: Matrix.identity(1)}),
            input=LinearMap(
                {}, {1: Matrix.from_rows([["1/4"]])}, reference=Matrix.from_rows([[2]])
            ),
        ),
    ),
)


def written(kind: str, arrays: dict[str, Any]) -> bytes:
    """The file of arrays as other programs write it."""
    stream, names = io.BytesIO(), ["a", "b"]
    if kind == "mat":
        cell = np.empty((1, 2), dtype=object)
        cell[0, :] = names
        scipy.io.savemat(stream, {**arrays, "names": cell})  # type: ignore[arg-type]
    else:
        np.savez(stream, **arrays, names=np.array(names))
    return stream.getvalue()


@pytest.mark.parametrize("kind", ["mat", "npz"])
def test_files_of_other_programs_are_read_with_a_warning_of_floats(
    kind: str, tmp_path: Path
) -> None:
    path = tmp_path / f"controller.{kind}"
    path.write_bytes(written(kind, by_hand()))
    with pytest.warns(RoundingWarning, match="by the rounding 'simplest'"):
        assert same(load_controller(path), EXPECTED)
    binary = load_controller(path, rounding="dyadic")
    assert binary.agents[0].private_update.outputs[0][0, 0] == Fraction(0.1)
    path.write_bytes(written(kind, by_hand() | {"rounding": "decimal"}))
    assert load_controller(path).agents[0].input.private != EXPECTED.agents[0].input.private


@pytest.mark.parametrize("kind", ["mat", "npz"])
def test_what_is_no_controller_is_refused_with_the_place(kind: str) -> None:
    changes: list[tuple[dict[str, Any], str]] = [
        ({"format": "mcexact-controller/9"}, "format: expected"),
        ({"time": "sometimes"}, "time"),
        ({"A": np.eye(2)}, "unknown"),
        ({"u_3_z": np.array([[1.0]])}, "u_3_z: there is no agent 3"),
        ({"u_1_x_9": np.array([[1.0]])}, "u_1_x_9: there is no agent 9"),
        ({"private": np.array([[1, 0, 0]])}, "private: expected 2 integers"),
        ({"private": np.array([[0.5, 0]])}, "private: expected 2 integers"),
        ({"u_1_z": np.ones((1, 2))}, r"agents\[0\].input.private"),
        ({"hold": np.array([[0, 0.5], [0, 0]])}, "hold: expected 2 × 2 integers"),
        ({"hold": np.array([[0, 1]])}, "hold: expected 2 × 2 integers"),
        ({"rounding": "upwards"}, "rounding"),
    ]
    for change, message in changes:
        with pytest.raises(InputError, match=message):
            read_controller(written(kind, by_hand() | change))
    for missing in ("format", "time", "shared"):
        rest = {key: value for key, value in by_hand().items() if key != missing}
        with pytest.raises(InputError, match=missing):
            read_controller(written(kind, rest))
    whole = written(kind, by_hand())
    for end in (10, 200, len(whole) - 40):
        with pytest.raises(InputError):
            read_controller(whole[:end])


@pytest.mark.slow
def test_controllers_are_converted_and_used_by_commands(tmp_path: Path) -> None:
    start, mat, npz, end = (tmp_path / f"c{k}" for k in (".json", ".mat", ".npz", "2.json"))
    controller = replace(drawn(1), system="")
    save_controller(controller, start)
    for source, target in ((start, mat), (mat, npz), (npz, end)):
        status, _, said = call("convert", str(source), "-o", str(target))
        assert status == 0, said
    assert json.loads(end.read_text()) == json.loads(start.read_text())
    for options, told in (
        (("-o", str(tmp_path / "c.yaml")), "choose .json, .mat, .npz"),
        (("-o", str(mat), "--inputs", "1"), "leave out --inputs"),
        (("-o", str(mat), "--modulo", "both"), "--at and --modulo"),
    ):
        status, _, said = call("convert", str(start), *options)
        assert status in (2, 3) and told in said, said
    (tmp_path / "hand.npz").write_bytes(written("npz", by_hand()))
    status, told, said = call("convert", str(tmp_path / "hand.npz"))
    assert status == 0 and "by the rounding 'simplest'" in said
    assert same(read_controller(told), EXPECTED)
    status, _, said = call("export", str(npz), "--to", "json", "-o", str(tmp_path / "sums.json"))
    assert status == 0, said
