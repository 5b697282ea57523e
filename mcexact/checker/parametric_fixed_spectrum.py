"""Kind ``parametric_fixed_spectrum``: all fixed modes for all values of a parameter."""

from . import evidence, reading
from .arithmetic import Polynomial
from .budget import counted
from .moved_modes import MovedModes
from .parameter_values import REAL, listed_value, roots_text, values_left_out, where_text
from .parametric_system import ParametricSystem
from .reading import Json, fields, items, require
from .statement import FIXED, PENCIL, channel_set, polynomial_text
from .two_variables import read, read_coefficients, text
from .zero_blocks import zero_block

WITNESS = (
    "gains", "modulus", "moduli", "common", "generic", "exceptional", "settled", "undefined"
)  # fmt: skip


def check(claim: Json, witness: Json, system: ParametricSystem) -> None:
    """Check a zero block for every mode, and that no other value and no other mode is left.

    Open: see ``proofs/OPEN.md``.
    """
    whole, listed, left_out = fields(claim, "claim", "generic", "exceptional", "outside")
    drawn, number, numbers, common, blocks, local, rest, poles = fields(
        witness, "witness", *WITNESS
    )
    P = [read(p, f"claim.generic[{k}]") for k, p in enumerate(items(whole, "claim.generic"))]
    for k, block in enumerate(counted(items(blocks, "witness.generic", len(P)))):
        zero_block(block, f"witness.generic[{k}]", system, P[k])
    moved, values = MovedModes(drawn, number, P, system), []
    proofs = items(local, "witness.exceptional", len(items(listed, "claim.exceptional")))
    for k, proof in enumerate(counted(proofs)):
        values.append(_exceptional(listed[k], proof, f"exceptional[{k}]", moved, system))
    for k, entry in enumerate(counted(items(rest, "witness.settled"))):
        place = f"witness.settled[{k}]"
        value, divisors = fields(entry, place, "value", "divisors")
        values.append(reading.polynomial(value, f"{place}.value", 1))
        moved.require_complete(values[-1], [], divisors, f"{place}.divisors")
    values += values_left_out(left_out, poles, system)
    moduli = [evidence.modulus(ell, "witness.moduli") for ell in items(numbers, "witness.moduli")]
    moved.require_no_other(values, common, moduli)


def _exceptional(
    entry: Json, proof: Json, where: str, moved: MovedModes, system: ParametricSystem
) -> Polynomial:
    """A value q, at whose roots the modes listed are fixed, and no others but generic ones."""
    place, inside = f"claim.{where}", f"witness.{where}"
    value, discs, listed = fields(entry, place, "value", "roots", "modes")
    blocks, divisors = fields(proof, inside, "modes", "divisors")
    q = listed_value(value, discs, place, system)
    count, modes = len(items(listed, f"{place}.modes")), []
    require(count > 0, "claim", f"{place}.modes", "expected at least one mode")
    for k, block in enumerate(items(blocks, f"{inside}.modes", count)):
        p, names = fields(listed[k], f"{place}.modes[{k}]", "polynomial", "channels")
        s = reading.names(names, f"{place}.modes[{k}].channels", system.names)
        modes.append(read(p, f"{place}.modes[{k}].polynomial", q))
        T = zero_block(block, f"{inside}.modes[{k}]", system, modes[-1], q)
        right = s == system.others(T)
        require(right, "claim", f"{place}.modes[{k}]", "T is not the complement of s")
        moved.require_new(q, modes[-1], f"{place}.modes[{k}]")
    moved.require_complete(q, modes, divisors, f"{inside}.divisors")
    return q


def statement(claim: Json, system: ParametricSystem) -> str:
    """The fixed modes for every value of the parameter."""
    t, delta = system.parameter, polynomial_text(system.scale, system.parameter)
    scaled = "" if delta == "1" else f", multiplied by {delta},"
    where, fixed = where_text(claim, system), f"the modes that are {FIXED}{scaled} are the roots x"
    listed = [(roots_text(each, t), _modes_text(each, t)) for each in claim["exceptional"]]
    if not claim["generic"]:
        texts = [f"but at {roots}, {REAL}, {fixed} of {modes}" for roots, modes in listed]
        return "; ".join([f"{where}, no mode is {FIXED}", *texts])
    always = ", ".join(text(read_coefficients(p), t) for p in claim["generic"])
    texts = [f"at {roots}, {REAL}, and there also those of {modes}" for roots, modes in listed]
    return "; ".join([f"{where}, {fixed} of {always}", *texts, "no others"])


def _modes_text(entry: Json, t: str) -> str:
    """The modes that are fixed at the roots of a value besides the generic ones."""
    return " and ".join(
        f"{text(read_coefficients(mode['polynomial']), t)}, where {PENCIL} with the matrix A, the "
        f"matrix C of the outputs of {channel_set(mode['channels'])} and the matrix B of the "
        "inputs of the others loses rank"
        for mode in entry["modes"]
    )
