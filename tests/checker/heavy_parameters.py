"""Small documents about parameters and boxes that ask for much work, by the loop they aim at."""

from __future__ import annotations

from string import ascii_lowercase
from typing import Any

from tests.checker.handmade import certificate, layers, matrix, plant

Document = dict[str, Any]

NOWHERE = {"generic": [], "exceptional": [], "outside": []}
WHOLE = {"cuts": [None], "parts": [{}]}
NO_BOUND = {"bound": None}
MEASURED = ([[1]], [[1]])
NINES = 10**4000 - 1
MANY = tuple(f"p{i:03}" for i in range(100))
EMPTY = {"denominator": 1, "re": [], "im": []}
PRIMES = [p for p in range(50_001, 60_000, 2) if all(p % d for d in range(2, int(p**0.5) + 1))]


def free(A: Any, *ports: Any, parameters: Any = ("t",), time: str = "continuous") -> Document:
    """A plant whose parameters have no ranges."""
    known: Document = {name: {} for name in parameters}
    return {**plant(A, *(ports or [MEASURED]), time=time), "parameters": known}


def within(
    A: Any, *ports: Any, parameters: Any = ("t",), ends: Any = (0, 1), time: str = "continuous"
) -> Document:
    """A plant whose parameters have the same range."""
    known = {name: {"range": [*ends]} for name in parameters}
    return {**plant(A, *(ports or [MEASURED]), time=time), "parameters": known}


def square(entry: Any, n: int) -> list[list[Any]]:
    """n rows of n equal entries."""
    return [[entry] * n for _ in range(n)]


def ports(n: int, number: int = 1) -> list[Any]:
    """Channels with one input and one output, which are certain."""
    return [([[1]] * n, [[1] * n])] * number


def step(construction: str, **parameters: Any) -> Document:
    """A construction of a subject."""
    return {"construction": construction, **parameters}


def longer(*dimensions: int) -> Document:
    """The construction that adds states."""
    return step("extended", share="states", dimensions=[*dimensions])


def fixed(system: Document, *subject: Document, claim: Any = None, **witness: Any) -> Document:
    """All fixed modes for all values, without evidence but this."""
    m = len(system["channels"])
    width = [
        (len(c["B"][0]) if c["B"] else 0, len(c["C"]))
        for c in system["channels"]
    ]  # fmt: skip
    gains = [[matrix(*[[g] * q for _ in range(p)]) for p, q in width] for g in (0, 1, 2)]
    given: Document = {"gains": gains if m else [], "modulus": 2**61 - 1, "moduli": []}
    lists = ("common", "generic", "exceptional", "settled", "undefined")
    given |= {key: [] for key in lists}
    return certificate(
        "parametric_fixed_spectrum",
        system,
        {**NOWHERE, **(claim or {})},
        {**given, **witness},
        *subject,
    )


def ranked(
    system: Document, name: Document, rank: int, *subject: Document, claim: Any = None, **more: Any
) -> Document:
    """The rank of a matrix for all values."""
    whole = {"matrix": name, "rank": rank, "exceptional": [], "outside": [], **(claim or {})}
    witness = {"kernel": None, "rows": [*range(rank)], "columns": [*range(rank)], "modulus": 10007}
    witness |= {"compressions": [matrix(), matrix()], "exceptional": [], "undefined": []}
    return certificate("parametric_rank", system, whole, {**witness, **more}, *subject)


def in_ranges(system: Document, *subject: Document, **witness: Any) -> Document:
    """No fixed mode for all values in the ranges."""
    return certificate("parametric_box_fixed", system, NO_BOUND, {**WHOLE, **witness}, *subject)


def controlled(system: Document, *subject: Document, **witness: Any) -> Document:
    """What channels control for all values in the ranges."""
    claim = {"channels": ["1"], **NO_BOUND}
    whole = {**WHOLE, **witness}
    return certificate("parametric_box_controllable", system, claim, whole, *subject)


def lasting(system: Document, *subject: Document, **part: Any) -> Document:
    """Stability for all values in the ranges."""
    keys = {"nominal": {"method": "polynomial"}, "points": [], "growth": None, "segments": []}
    witness = {"cuts": [None], "parts": [{**keys, "frames": [], **part}]}
    claim = {**NO_BOUND, "gain_radii": None}
    return certificate("parametric_box_stable", system, claim, witness, *subject)


def real(rows: Any, denominator: int = 1) -> Document:
    """A real matrix as a complex one."""
    return {"denominator": denominator, "re": rows, "im": [[0] * len(row) for row in rows]}


def unit(n: int, size: int = 1) -> list[list[int]]:
    """A multiple of an identity matrix."""
    return [[size * (i == j) for j in range(n)] for i in range(n)]


def discs(n: int, radius: str = "9", entry: int = 1, number: int = 1) -> list[Document]:
    """Lists of discs around 0, by coordinates with such entries."""
    Y = real(unit(n, entry))
    listed = [{"re": "0", "im": "0", "radius": radius}] * n
    return [{"F": None, "Y": Y, "T": Y, "discs": listed}] * number


def boxed(
    system: Document, *subject: Document, kind: str = "box_fixed", claim: Any = None, **witness: Any
) -> Document:
    """No fixed mode in the box of a plant, or another claim about it."""
    known = {"exterior": [], "gains": [], "frames": [], "cover": []}
    return certificate(kind, system, claim or NO_BOUND, {**known, **witness}, *subject)


def doubtful(A: Any, *given: Any, time: str = "continuous", **graph: Any) -> Document:
    """A plant with a radius of its first entry."""
    form = {"shape": [len(A), len(A)], "entries": [[0, 0, "1/100"]]}
    doubt = {"absolute": {"A": form}}
    return plant(A, *(given or ports(len(A))), time=time, **graph, uncertainty=doubt)


def program(n: int, **maps: Any) -> Document:
    """A closed loop with one agent of n states."""
    parts = {"shared_update": {}, "private_update": {}, "input": {}, **maps}
    agent = {"name": "1", "shared": 0, "private": n, **parts}
    return step("closed_loop", controller={"time": "continuous", "agents": [agent]})


def bare(n: int) -> tuple[Any, Any]:
    """No inputs and no outputs of n states."""
    return [[]] * n, {"shape": [0, n], "entries": []}


def block(*U: Document, W: Document) -> Document:
    """A zero block of one state."""
    parts = {"channels_T": [], "U": [*U], "W": W}
    return {**parts, "row_pivots": [0], "column_pivots": [0]}


def with_roots(number: int, apart: int = 1) -> list[int]:
    """The monic polynomial whose roots are so many multiples of a number."""
    p = [1]
    for k in range(1, number + 1):
        p = [a - apart * k * b for a, b in zip([0, *p], [*p, 0], strict=True)]
    return p


def around(number: int, apart: int = 1, digits: str = "") -> list[Document]:
    """Discs around its roots, with more digits."""
    radius = "0.1" if digits else "0"
    return [
        {"re": f"{apart * k}{digits}", "im": "0", "radius": radius} for k in range(1, number + 1)
    ]


def power(p: str, exponent: int) -> str:
    """A power of a sum."""
    return f"({p})^{exponent}"


def dense(degree: int) -> str:
    """A polynomial in canonical form, all of whose coefficients are there."""
    powers = [f"t^{k}" for k in range(degree, 1, -1)]
    return " + ".join([*powers, "t", "1"])


A16 = "(1)/(" + "*".join(ascii_lowercase[:16]) + ")"
SUMS = "*".join(f"({x} + {x}{x})" for x in ascii_lowercase[:20])
NULLS = [[None] * 1500]

LOOPS: dict[str, tuple[str, Document]] = {
    # reading
    "the dual of 16 powers of degree 1000": (
        "parametric_system._cleared",
        fixed(free(square("t^1000", 4), *ports(4)), step("dual")),
    ),
    "200 powers of degree 1000": (
        "parametric_system._cleared",
        fixed(free(square("t^1000", 14), *ports(14)), step("dual")),
    ),
    "entries of 80 denominators": (
        "parametric_system._cleared",
        fixed(
            free([[f"(1)/(t - {9 * i + j})" for j in range(1, 10)] for i in range(9)], *ports(9))
        ),
    ),
    "powers of a sum of degree 1000": (
        "expressions.Reader.raised",
        fixed(free(square(power("1 + t", 1000), 20), *ports(20))),
    ),
    "powers of powers": (
        "expressions.Reader.raised",
        fixed(free(square("(((1/3 + t)^10)^10)^10", 18), *ports(18))),
    ),
    "a number of 4000 digits to the power 1000": (
        "expressions.Reader.raised",
        fixed(free([[f"{NINES}^1000*t"]])),
    ),
    "quotients of powers": (
        "expressions.common_divisor",
        fixed(free(square("(1 + t)^200/(2 - t)^190", 18), *ports(18))),
    ),
    "a sum of 700 quotients": (
        "expressions.Reader.fraction",
        fixed(free([["+".join(f"1/(t+{k})" for k in range(700))]])),
    ),
    "a sum of 4000 numbers": (
        "expressions.Reader.fraction",
        fixed(free([["+".join(["1"] * 4000)]])),
    ),
    "products of 900 factors": (
        "expressions.Reader.product",
        fixed(free([["*".join(["t"] * 900)] * 2] * 2, *ports(2))),
    ),
    "coefficients of 90 digits": (
        "expressions.Reader.fraction",
        fixed(free([["+".join(f"{10**90 + k}*t^{k}/7" for k in range(90))]])),
    ),
    "polynomials of degree 300 over two denominators": (
        "parametric_system._cleared",
        fixed(free([[f"({dense(300)})/(t - 2)", dense(300)]] * 2, *ports(2))),
    ),
    "a matrix of a million zeros": (
        "parametric_system._table",
        fixed(free({"shape": [3000, 3000], "entries": []}, ([], []))),
    ),
    "channels without states": (
        "parametric_system.cleared_tables",
        ranked(free([], *[([], [])] * 330), {"name": "setpoint"}, 0),
    ),
    "a power of a sum of 30 parameters": (
        "several_parameters.times",
        in_ranges(within([[power("+".join(MANY[:30]), 5)]], parameters=MANY[:30])),
    ),
    "squares of a sum of 100 parameters": (
        "several_parameters.times",
        in_ranges(within(square(power("+".join(MANY), 2), 3), *ports(3), parameters=MANY)),
    ),
    "a product of 20 sums": (
        "several_parameters.times",
        in_ranges(
            within([[SUMS]], parameters=[x * k for x in ascii_lowercase[:20] for k in (1, 2)])
        ),
    ),
    "sums of sums of 100 parameters": (
        "several_parameters.plus",
        in_ranges(within([["+".join(["+".join(MANY)] * 10)]], parameters=MANY)),
    ),
    "600 entries with 100 parameters": (
        "several_parameters.quotient_text",
        in_ranges(within(square("p000*p099", 24), *ports(24), parameters=MANY)),
    ),
    # fixed modes
    "a plant with 300 states more": (
        "cells.rearranged",
        ranked(free([["t"]]), {"name": "setpoint"}, 1, longer(300)),
    ),
    "a plant with 20 states more, of degree 200": (
        "two_variables.characteristic",
        fixed(free([[dense(200)]]), longer(20), gains=[[matrix(*square(1, 21))]] * 3),
    ),
    "a polynomial of degree 1000": (
        "interpolation.interpolated",
        fixed(free([["t^1000"]])),
    ),
    "determinants of degree 600": (
        "two_variables._characteristic_values",
        fixed(free([[f"t^{100 + i + j}" for j in range(6)] for i in range(6)], *ports(6))),
    ),
    "determinants of degree 300 modulo a number of 3000 digits": (
        "two_variables._at",
        fixed(free([[dense(300)]]), modulus=10**3000 + 9),
    ),
    "400 moduli": (
        "resultants.integer_resultant",
        fixed(free([["t^40", "t"], [1, "t^30"]], *ports(2)), moduli=PRIMES[:400]),
    ),
    "a modulus of 4000 digits": (
        "resultants.resultant",
        fixed(free([["t^60", "t"], [1, "t^30"]], *ports(2)), moduli=[10**4000 + 1]),
    ),
    "a resultant of large degree": (
        "resultants._of_values",
        fixed(free([[f"t^{9 + i + j}" for j in range(6)] for i in range(6)], *ports(6))),
    ),
    "coefficients of 2000 digits": (
        "resultants.integer_resultant",
        fixed(free([[f"{10**2000 + 1}*t^2", 1], [1, "t"]], *ports(2)), moduli=[2**61 - 1]),
    ),
    "settled values with 300 divisors": (
        "moved_modes.require_complete",
        fixed(
            free([["t", 0], [0, "t^2"]], *ports(2)),
            settled=[{"value": [0] * 400 + [1], "divisors": [[[k], [1]] for k in range(1, 301)]}],
        ),
    ),
    "common values of degree 200": (
        "moved_modes._modular",
        fixed(
            free([["t^9", 1], [2, "t^3"]], *ports(2)),
            settled=[{"value": [0] * 200 + [1], "divisors": []}],
            common=[{"value": [0] * 200 + [1], "divisor": [[0] * 150 + [1], [1]]}] * 12,
        ),
    ),
    "a generic polynomial of degree 150": (
        "zero_blocks.zero_block",
        fixed(
            free([["t"]], ([[0]], [[0]])),
            claim={"generic": [[[1]] * 151]},
            generic=[block(layers([[1]]), *[layers([[0]])] * 149, W=layers([[1]]))],
        ),
    ),
    "a zero block of 500 layers": (
        "layered.product",
        fixed(
            free([[dense(200)]], ([[0]], [[0]])),
            claim={"generic": [[[1], [1]]]},
            generic=[block(layers(*[[[1]]] * 500), W=layers(*[[[1]]] * 500))],
        ),
    ),
    "a zero block modulo a polynomial of degree 30": (
        "layered.reduced",
        fixed(
            free([[dense(60)]], ([[0]], [[0]])),
            claim={
                "exceptional": [
                    {
                        "value": with_roots(30),
                        "roots": around(30),
                        "modes": [{"polynomial": [[1], [1]], "channels": ["1"]}],
                    }
                ]
            },
            exceptional=[
                {
                    "modes": [block(layers([[1]]), W=layers([[1]], *[[[0]]] * 28, [[1]]))],
                    "divisors": [],
                }
            ],
        ),
    ),
    "discs of many digits beyond the range": (
        "parameter_values.values_left_out",
        fixed(
            within([["t"]]),
            claim={
                "outside": [
                    {"value": with_roots(40, 3), "roots": around(40, 3, "." + "0" * 59 + "1")}
                ]
            },
        ),
    ),
    "30 poles": (
        "parameter_values.values_left_out",
        fixed(
            free([[f"(1)/(t - {k})" for k in range(1, 31)]] + [[0] * 30] * 29, bare(30)),
            gains=[[matrix()]] * 3,
            undefined=[[-k, 1] for k in range(1, 31)],
        ),
    ),
    # ranks
    "a signal of degree 1000 without states": (
        "named_matrices._signals",
        ranked(free([], ([], [])), {"name": "signal", "polynomial": [0] * 1000 + [1]}, 0),
    ),
    "a signal of degree 300": (
        "named_matrices._signals",
        ranked(free([["t"]]), {"name": "signal", "polynomial": [0] * 300 + [1]}, 1),
    ),
    "100 blocks of a plant of 100 states": (
        "named_matrices.named_matrix",
        ranked(
            free([["t^5"]]), {"name": "controllability", "channels": ["1"], "blocks": 100}, 1,
            longer(99),
        ),
    ),
    "the factors of a transfer matrix of 150 states": (
        "named_matrices.named_matrix",
        ranked(free([["t^9"]]), {"name": "transfer", "from": "1", "to": "1"}, 1, longer(150)),
    ),
    "the factors of a transfer matrix of large degree": (
        "named_matrices._below_each_other",
        ranked(
            free(square("t^30", 12), *ports(12)), {"name": "transfer", "from": "1", "to": "1"}, 1
        ),
    ),
    "a kernel of 800 layers": (
        "parametric_rank._require_kernel",
        ranked(
            free([["t^900", 0], [0, 0]], bare(2)), {"name": "setpoint"}, 1,
            kernel={"columns": layers(*[[[1], [1]]] * 800), "pivots": [0]},
        ),
    ),
    "a minor of degree 800": (
        "two_variables.determinant",
        ranked(
            free([[f"t^{90 + i * j}" for j in range(8)] for i in range(8)], bare(8)),
            {"name": "setpoint"}, 8, compressions=[matrix(*unit(8))] * 2,
        ),
    ),
    "compressions of many digits": (
        "arithmetic.poly_divide",
        ranked(
            free([["t^60", 1], [1, "t^30"]], bare(2)), {"name": "setpoint"}, 2,
            compressions=[matrix([10**1900, 1], [1, 1])] * 2,
        ),
    ),
    # cells
    "one parameter, and 300 states more": (
        "parameter_cells.box_of_cell",
        in_ranges(within([["t"]]), longer(300)),
    ),
    "100 parameters, and 30 states more": (
        "parameter_cells._form",
        in_ranges(within([[0]], parameters=MANY), longer(30)),
    ),
    "100 parameters, and 80 states more": (
        "parameter_cells._form",
        in_ranges(within([["p000"]], parameters=MANY), longer(80)),
    ),
    "a denominator of 16 parameters": (
        "parameter_cells._form",
        in_ranges(
            within([[A16]], ([[1]], [[A16]] * 3), parameters=ascii_lowercase[:16], ends=(999, 1000))
        ),
    ),
    "a denominator of 16 parameters at 0": (
        "parameter_cells._form",
        in_ranges(within([[A16]], parameters=ascii_lowercase[:16], ends=(0, 1))),
    ),
    "a power of degree 1000 in a range": (
        "parameter_cells._shifted",
        in_ranges(within([["t^1000"]])),
    ),
    "polynomials of degree 300 in a range": (
        "parameter_cells._shifted",
        in_ranges(within([[dense(300)] * 2] * 2, *ports(2), ends=("1/1000003", 1))),
    ),
    "a product of powers of parameters": (
        "parameter_cells._largest",
        in_ranges(
            within([["a^30*b^30*c^30*d^30"]], parameters="abcd", ends=("1/3", "1000/7"))
        ),
    ),
    "2000 cuts of 100 parameters": (
        "parameter_cells.cells_of",
        in_ranges(within([[0]], parameters=MANY), cuts=[9] * 2000 + [None]),
    ),
    "31 cells of 60 parameters": (
        "function_loops.boxes_of_cells",
        in_ranges(
            within([], ([], []), parameters=MANY[:60]),
            cuts=[*[0] * 30, *[None] * 31],
            parts=[{"exterior": discs(0), "gains": [], "frames": [], "cover": []}] * 31,
        ),
    ),
    "channels without states in a range": (
        "parameter_cells._matrix",
        in_ranges(within([], *[([], [])] * 200, parameters=MANY[:60])),
    ),
    "30 channels and 60 parameters with gains": (
        "box_fixed.augmented",
        in_ranges(
            within([[0]], *ports(1, 30), parameters=MANY[:60]),
            parts=[
                {
                    "exterior": discs(1),
                    "gains": [{"X": [matrix([1])] * 30, "W": [matrix([1])] * 30}] * 2,
                    "frames": [],
                    "cover": [[None] * 9],
                }
            ],
        ),
    ),
    "the inputs of 60 states under 60 parameters": (
        "box_controllable.check",
        controlled(within([[0]], parameters=MANY[:60]), longer(60)),
    ),
    "discs of 8 states under 60 parameters": (
        "exterior_discs.exterior_discs",
        in_ranges(
            within(unit(8), *ports(8), parameters=MANY[:60]),
            parts=[{"exterior": discs(8, number=4), "gains": [], "frames": [], "cover": []}],
        ),
    ),
    "frames of 8 states under 60 parameters": (
        "regular_discs.left_inverse",
        in_ranges(
            within(unit(8), *ports(8), parameters=MANY[:60]),
            parts=[
                {
                    "exterior": discs(8), "gains": [], "cover": [[0]] * 8,
                    "frames": [{"gains": None, "V": real(unit(8)), "w": [1] * 8}] * 8,
                }
            ],
        ),
    ),
    "gains of 8 states under 60 parameters": (
        "boxes.Box.independent",
        in_ranges(
            within(unit(8), *ports(8), parameters=MANY[:60]),
            parts=[
                {
                    "exterior": [{**discs(8)[0], "F": [matrix([1])]}] * 4,
                    "gains": [], "frames": [], "cover": [],
                }
            ],
        ),
    ),
    "frames of the inputs of 6 states under 60 parameters": (
        "regular_discs.right_inverse",
        controlled(
            within(unit(6), *ports(6), parameters=MANY[:60]),
            parts=[
                {
                    "exterior": discs(6), "cover": [[0]] * 6,
                    "frames": [{"R": real([*unit(6), [1] * 6]), "w": [1] * 6}] * 8,
                }
            ],
        ),
    ),
    "a loop under 60 parameters": (
        "loop_pencil.loop_pencil",
        lasting(within([["-p000 - 1"]], parameters=MANY[:60]), program(40)),
    ),
    "a loop of 200 states in a range": (
        "function_loops.members_of_cell",
        lasting(within([["t"]]), program(200)),
    ),
    "growth with weights of 4000 digits": (
        "box_stable._require_growth",
        lasting(within([["-t - 1"]]), points=[1], growth=[NINES]),
    ),
    # boxes
    "discs of 20 states of many digits": (
        "exterior_discs.exterior_discs",
        boxed(doubtful(unit(20)), exterior=discs(20, "9" * 60, 10**40), cover=[[0]] * 20),
    ),
    "discs of 300 states more": (
        "exterior_discs.exterior_discs",
        boxed(doubtful([[1]], neighbors={"1": []}), longer(300), exterior=discs(1)),
    ),
    "frames of many digits": (
        "regular_discs.near_identity",
        boxed(
            doubtful(unit(4)), exterior=discs(4), cover=[[0] * 4] * 4,
            frames=[{"gains": None, "V": real(unit(4, 10**500)), "w": [10**500] * 4}] * 2,
        ),
    ),
    "a cover of 1500 squares by many lists": (
        "covers.require_covered",
        boxed(doubtful([[1]]), exterior=discs(1, number=15), cover=NULLS),
    ),
    "a cover of 1500 squares of 2000 digits": (
        "covers.require_covered",
        boxed(doubtful([[1]]), exterior=discs(1, "9" * 2000), cover=NULLS),
    ),
    "cells by a frame of many digits": (
        "regular_discs.near_identity",
        boxed(
            doubtful([[1]]), exterior=discs(1), cover=[[None] * 900 + [0] * 900],
            frames=[{"gains": None, "V": real([[10**2000]]), "w": [1]}],
        ),
    ),
    "900 points of a circle": (
        "box_stable.segments_of",
        boxed(
            doubtful([[0]], time="discrete"), kind="box_stable",
            claim={**NO_BOUND, "gain_radii": None},
        )
        | {
            "witness": {
                "nominal": {"method": "polynomial"}, "points": [*range(1, 900)], "growth": None,
                "segments": [0] * 900, "frames": [],
            }
        },
    ),
    "points of 2000 digits": (
        "box_stable._arc",
        boxed(
            doubtful([[0]], time="discrete"), kind="box_stable",
            claim={**NO_BOUND, "gain_radii": None},
        )
        | {
            "witness": {
                "nominal": {"method": "polynomial"}, "points": [f"1/{NINES}", f"2/{10**3000 + 1}"],
                "growth": None, "segments": [0] * 3, "frames": [],
            }
        },
    ),
    "the inputs of 300 states in a box": (
        "box_controllable.check",
        boxed(
            doubtful([[1]], neighbors={"1": []}), longer(300), kind="box_controllable",
            claim={"channels": ["1"], **NO_BOUND},
        ),
    ),
    "radii of 200 constructions": (
        "boxes.box_of",
        boxed(doubtful(unit(16), *ports(16)), *[step("dual")] * 200),
    ),
    "a loop of 300 states in a box": (
        "loop_pencil.loop_pencil",
        boxed(
            doubtful([[-1]]), program(300), kind="box_stable",
            claim={**NO_BOUND, "gain_radii": None},
        ),
    ),
    "channels without states in a box": (
        "box_fixed.augmented",
        boxed(
            plant([], *[([], [])] * 90), exterior=discs(0),
            gains=[{"X": [matrix()] * 90, "W": [matrix()] * 90}],
        ),
    ),
}  # fmt: skip
"""The loop that each document aims at, and the document."""

HEAVY = {name: document for name, (_, document) in LOOPS.items()}

EXPECTED = {
    "a sum of 4000 numbers": ("MALFORMED", "form"),
    "coefficients of 90 digits": ("MALFORMED", "form"),
    "channels without states": ("VALID", ""),
    "600 entries with 100 parameters": ("MALFORMED", "form"),
    "a resultant of large degree": ("INVALID", "degree"),
    "coefficients of 2000 digits": ("INVALID", "modulus"),
    "settled values with 300 divisors": ("INVALID", "divisor"),
    "common values of degree 200": ("INVALID", "divisor"),
    "a generic polynomial of degree 150": ("INVALID", "identity"),
    "a zero block modulo a polynomial of degree 30": ("INVALID", "pivots"),
    "discs of many digits beyond the range": ("VALID", ""),
    "30 poles": ("INVALID", "degree"),
    "the factors of a transfer matrix of large degree": ("MALFORMED", "form"),
    "a kernel of 800 layers": ("INVALID", "identity"),
    "compressions of many digits": ("INVALID", "common_factor"),
    "100 parameters, and 30 states more": ("MALFORMED", "form"),
    "2000 cuts of 100 parameters": ("INVALID", "cuts"),
    "31 cells of 60 parameters": ("VALID", ""),
    "channels without states in a range": ("MALFORMED", "form"),
    "30 channels and 60 parameters with gains": ("INVALID", "cover"),
    "discs of 8 states under 60 parameters": ("MALFORMED", "form"),
    "frames of 8 states under 60 parameters": ("INVALID", "cell"),
    "gains of 8 states under 60 parameters": ("INVALID", "disc"),
    "frames of the inputs of 6 states under 60 parameters": ("INVALID", "cell"),
    "a loop under 60 parameters": ("INVALID", "claim"),
    "a loop of 200 states in a range": ("INVALID", "claim"),
    "growth with weights of 4000 digits": ("INVALID", "growth"),
    "discs of 20 states of many digits": ("MALFORMED", "form"),
    "frames of many digits": ("INVALID", "cell"),
    "cells by a frame of many digits": ("INVALID", "cell"),
    "900 points of a circle": ("MALFORMED", "form"),
    "points of 2000 digits": ("MALFORMED", "form"),
    "radii of 200 constructions": ("MALFORMED", "form"),
    "a loop of 300 states in a box": ("MALFORMED", "form"),
    "channels without states in a box": ("VALID", ""),
}
"""The verdicts and codes of those that the default decides; the others are INCOMPLETE."""
