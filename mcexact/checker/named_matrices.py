"""Matrices of polynomials in a parameter that are made from a plant, by name."""

from . import layered
from .arithmetic import Matrix, beside, stack
from .budget import counted
from .parametric_system import Layers, ParametricSystem
from .reading import Json, fields, integer, malformed, names, require, shown, string
from .statement import channel_set, quoted

KEYS = {"setpoint": (), "controllability": ("channels", "blocks"), "transfer": ("from", "to")}


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
        return _equilibria(system)
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
        product = layered.product(row, system.B[j])
        columns += [[layer.take(cols=[k]) for layer in product] for k in range(product[0].ncols)]
        row = layered.product(row, system.A)
    return _below_each_other(columns, 1)


def _equilibria(system: ParametricSystem) -> Layers:
    """[A', B'; C', 0], in discrete time [A' − δI, B'; C', 0]."""
    n, A = system.n, system.A
    if system.time == "discrete":
        identity = Matrix.unit_rows(n, 0, n)
        A = layered.difference(A, [identity.times(c) for c in system.poles[0]])
    B, C = _side_by_side(list(system.B), n), _below_each_other(list(system.C), n)
    lower = _side_by_side([C, [Matrix.zeros(C[0].nrows, B[0].ncols)]], C[0].nrows)
    return _below_each_other([_side_by_side([A, B], n), lower], n + B[0].ncols)


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
    if value["name"] == "setpoint":
        shift = " - I" if system.time == "discrete" else ""
        return f"[A{shift}, B; C, 0], B and C those of all channels,"
    if value["name"] == "controllability":
        inputs = f"B the inputs of the channels {channel_set(value['channels'])}"
        return f"[B, A B, ..., A^(k-1) B], {inputs} and k = {value['blocks']},"
    ends = f"B the inputs of channel {quoted(value['from'])}, C the outputs of channel"
    return f"the column of all entries of C A^k B, k < {system.n}, {ends} {quoted(value['to'])},"
