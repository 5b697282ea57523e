"""Documents made to be believed without reason, to crash the checker or to wear it out."""

from __future__ import annotations

import json
from typing import Any

import pytest

from mcexact.checker.core.reach import components
from mcexact.checker.core.reading import Limits
from mcexact.checker.kinds import check_document
from tests import effort
from tests.checker.handmade import INTEGRATOR, certificate, plant


def complete(m: int, n: int = 1, **more: Any) -> dict[str, Any]:
    """A plant of n states in which every one of m agents hears every other."""
    names = [str(i) for i in range(1, m + 1)]
    ports = ([[1]] * n, [[1] * n])
    heard = {i: [j for j in names if j != i] for i in names}
    return plant([[0] * n] * n, *[ports] * m, time="discrete", neighbors=heard, **more)


def connected(system: dict[str, Any], *subject: dict[str, Any]) -> bytes:
    claim = {"strongly_connected": True}
    return json.dumps(certificate("neighbor_graph", system, claim, {}, *subject)).encode()


def agent(name: str, shared: int = 0, **maps: Any) -> dict[str, Any]:
    program = {"shared_update": {}, "private_update": {}, "input": {}}
    return {"name": name, "shared": shared, "private": 0, **program, **maps}


def loop(domain: str, stable: bool, steps: int, width: int, update: Any, **more: Any) -> bytes:
    """The loop of two agents, the first of which uses what the second has sent ``steps`` ago."""
    ports = ([[0]], [[1]])
    graph = {"neighbors": {"1": ["2"], "2": ["1"]}}
    if steps:
        graph["delays"] = {"1": {"2": steps}}  # type: ignore[dict-item]
    system = plant([[-1]], ports, ports, time=domain, **graph)
    uses = {"shared": {"2": [[1] * width]}}
    second = agent("2", width, shared_update=update, **more)
    controller = {"time": domain, "agents": [agent("1", input=uses), second]}
    step = {"construction": "closed_loop", "controller": controller}
    claim, witness = {"bound": None, "stable": stable}, {"method": "polynomial"}
    return json.dumps(certificate("stability", system, claim, witness, step)).encode()


def no_inputs(m: int, n: int) -> dict[str, Any]:
    port = ([[]] * n, {"shape": [0, n], "entries": []})
    return plant([[0] * n] * n, *[port] * m, neighbors={str(i): [] for i in range(1, m + 1)})


def bound(text: str) -> bytes:
    claim = {"bound": "?", "stable": False}
    document = certificate("stability", INTEGRATOR, claim, {"method": "polynomial"})
    return json.dumps(document).replace("?", text).encode()


OUTPUTS = {"construction": "augmented_outputs"}
NOTHING = {"construction": "extended", "share": "outputs+states", "dimensions": [0, 0]}
EXTENDED = {"construction": "extended", "share": "states", "dimensions": [30] * 60}
LIFTED = {**EXTENDED, "construction": "lifted"}
EMPTY = {"denominator": 1, "entries": []}
ERROR = {"construction": "error", "gains": [EMPTY] * 300}
DECAY = {"shared": {"2": [[-1]]}}

ATTACKS: list[tuple[str, bytes, str]] = [
    # in continuous time a shift register is no delay: its eigenvalues would be those of nothing
    ("a delay in continuous time", loop("continuous", False, 1, 1, DECAY), "INVALID"),
    ("held in continuous time", loop("continuous", False, 0, 1, DECAY, hold={"1": 1}), "INVALID"),
    ("no delay in continuous time", loop("continuous", True, 0, 1, DECAY), "VALID"),
    # empty messages are not kept, so that there are no registers to build
    ("millions of empty messages", loop("discrete", False, 4 * 10**6, 0, {}), "VALID"),
    ("a delay beyond any memory", loop("discrete", False, 10**30, 1, {}), "INCOMPLETE"),
    ("outputs doubled forty times", connected(complete(2), *[OUTPUTS] * 40), "INCOMPLETE"),
    ("extensions by nothing, forty times", connected(complete(2), *[NOTHING] * 40), "INCOMPLETE"),
    ("sub-states that all hear", connected(complete(60), EXTENDED), "INCOMPLETE"),
    ("late sub-states that all hear", connected(complete(60), LIFTED), "INCOMPLETE"),
    ("estimation errors of many agents", connected(no_inputs(300, 60), ERROR), "INCOMPLETE"),
    ("a string without an end", b'"' + b'\\"' * 200_000, "MALFORMED"),
    ("digits written as escapes", bound(r"\u0031" * 5000 + "/3"), "INCOMPLETE"),
    ("nested without an end", b"[" * 100_000, "MALFORMED"),
]


@pytest.mark.parametrize(
    ("data", "verdict"), [attack[1:] for attack in ATTACKS], ids=[name for name, *_ in ATTACKS]
)
def test_an_attack_is_answered_by_what_it_is_within_the_work_that_is_counted(
    data: bytes, verdict: str
) -> None:
    allowed = 50 * len(data) + 10**6
    with effort.at_most(allowed):
        found = check_document(data, limits=Limits(work=allowed))
    assert found.verdict == verdict, found.line()


def test_nesting_that_the_interpreter_cannot_read_is_no_bug_of_the_checker() -> None:
    found = check_document(b"[" * 10**6 + b"]" * 10**6, limits=Limits(depth=10**7))
    assert found.verdict == "MALFORMED", found.line()


def test_components_cost_the_square_of_the_number_of_agents() -> None:
    m = 300
    with effort.at_most(6 * m**2):
        assert components(m, [(j, (j + 1) % m) for j in range(m)]) == [list(range(m))]
    with effort.at_most(6 * m**2):
        assert components(m, [(j, j + 1) for j in range(m - 1)]) == [[j] for j in range(m)]
