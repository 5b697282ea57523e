"""Matrices of polynomials in a parameter that are made from a plant, by name."""

from . import layered
from .arithmetic import Matrix, Polynomial, beside, stack
from .budget import counted
from .parametric_system import Layers, ParametricSystem
from .reading import (
    Json,
    fields,
    integer,
    malformed,
    names,
    polynomial,
    require,
    shown,
    string,
)
from .statement import channel_set, polynomial_text, quoted

KEYS = {
    "setpoint": (),
    "signal": ("polynomial",),
    "controllability": ("channels", "blocks"),
    "transfer": ("from", "to"),
}


def named_matrix(value: Json, system: ParametricSystem) -> Layers:
    """The coefficients of a matrix, from those of A', B_i' and C_i'.

    Where no denominator vanishes, its rank is that of the same matrix made from A, B_i and C_i.

    Open: see ``proofs/OPEN.md``.
    """
    place = "claim.matrix"
    name = value.get("name") if isinstance(value, dict) else None
    if type(name) is not str or name not in KEYS:
        malformed(place, f"expected the name of a matrix, found {shown(name)}")
    _, *parts = fields(value, place, "name", *KEYS[name])
    if name == "setpoint":
        return _signals([-1 if system.time == "discrete" else 0, 1], system)
    if name == "signal":
        return _signals(polynomial(parts[0], f"{place}.polynomial", 1), system)
    if name == "controllability":
        T, k = names(parts[0], place, system.names), integer(parts[1], place, 1)
        require(k <= max(system.n, 1), "claim", place, f"expected at most {system.n} blocks")
        power, blocks = _side_by_side([system.B[i] for i in T], system.n), []
        for _ in counted(range(k)):
            blocks.append(power)
            power = layered.product(system.A, power)
        return _side_by_side(blocks, system.n)
    j, i = (names([name], place, system.names)[0] for name in parts)
    row, columns = system.C[i], []
    for _ in counted(range(system.n)):
        block = layered.product(row, system.B[j])
        columns += [[layer.take(cols=[k]) for layer in block] for k in range(block[0].ncols)]
        row = layered.product(row, system.A)
    return _below_each_other(columns, 1)


def _signals(p: Polynomial, system: ParametricSystem) -> Layers:
    """[I x A' - K x δI, I x B'; I x C', 0], K the companion matrix of p, which is monic."""
    n, d = system.n, len(p) - 1
    B, C = _side_by_side(list(system.B), n), _below_each_other(list(system.C), n)
    identity, q = Matrix.unit_rows(n, 0, n), C[0].nrows
    blank = {ends: [Matrix.zeros(*ends)] for ends in ((n, B[0].ncols), (q, n), (q, B[0].ncols))}
    upper, lower = [], []
    for i in counted(range(d)):
        row: list[Layers] = []
        for j in counted(range(d)):
            # the entry of -K: -1 below the diagonal, the coefficients of p in the last column
            c = (p[i] if j == d - 1 else 0) - (j == i - 1)
            block = [identity.times(-c * value) for value in system.scale]
            start = system.A if i == j else [Matrix.zeros(n, n)]
            row.append(layered.difference(start, block))
        inputs = [B if i == j else blank[n, B[0].ncols] for j in range(d)]
        upper.append(_side_by_side([*row, *inputs], n))
        outputs = [C if i == j else blank[q, n] for j in range(d)]
        lower.append(_side_by_side([*outputs, *[blank[q, B[0].ncols]] * d], q))
    return _below_each_other([*upper, *lower], d * (n + B[0].ncols))


def _side_by_side(parts: list[Layers], nrows: int) -> Layers:
    many = max([len(part) for part in parts] + [1])
    return [beside([_layer(part, k) for part in parts], nrows) for k in range(many)]


def _below_each_other(parts: list[Layers], ncols: int) -> Layers:
    many = max([len(part) for part in parts] + [1])
    return [stack([_layer(part, k) for part in parts], ncols) for k in range(many)]


def _layer(part: Layers, k: int) -> Matrix:
    return part[k] if k < len(part) else Matrix.zeros(part[0].nrows, part[0].ncols)


def named_text(value: Json, system: ParametricSystem) -> str:
    """A matrix in words."""
    string(value["name"], "claim.matrix.name", *KEYS)
    everyone = "the matrices A, B and C of all channels"
    if value["name"] == "setpoint":
        shift = " - I" if system.time == "discrete" else ""
        return f"[A{shift}, B; C, 0] with {everyone}"
    if value["name"] == "signal":
        blocks = "[kron(I, A) - kron(K, I), kron(I, B); kron(I, C), 0]"
        companion = f"the companion matrix K of {polynomial_text(value['polynomial'])}"
        return f"{blocks} with {everyone}, {companion} and the Kronecker product kron"
    if value["name"] == "controllability":
        blocks = f"the matrix of the first {value['blocks']} of the blocks B, A B, A^2 B, ..."
        inputs = f"the inputs of the channels {channel_set(value['channels'])}"
        return f"{blocks} with the matrix A and the matrix B of {inputs}"
    factors = f"the column of all entries of the first {system.n} of C B, C A B, C A^2 B, ..."
    inputs = f"the matrix B of the inputs of channel {quoted(value['from'])}"
    outputs = f"the matrix C of the outputs of channel {quoted(value['to'])}"
    return f"{factors} with the matrix A, {inputs} and {outputs}"
