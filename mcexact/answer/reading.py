"""Reading answers from certificates, according to the types of their fields."""

from __future__ import annotations

import json
import os
import sys
import types
import typing
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from fractions import Fraction
from typing import Any

from mcexact.answer.check import checked
from mcexact.answer.protocol import Answer, fields_of, is_optional, key_of, kind_named
from mcexact.derived.constructions import (
    LINE,
    add_links,
    along_line,
    augmented_outputs,
    dual,
    error_system,
    extended_system,
    feedback,
    full_output,
    held_system,
    lifted_system,
    looped,
    merged,
    moved,
    restricted,
    setpoint_system,
)
from mcexact.errors import InputError, place_of
from mcexact.exact.linear_algebra import PolynomialMatrix
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import Limits
from mcexact.model import controller, system_file
from mcexact.model import system as system_forms
from mcexact.model.loop import closed_loop
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import canonical, read_bytes


def load_certificate(
    path: str | os.PathLike[str], system: MultiChannelSystem | ParametricSystem | None = None
) -> Answer:
    """Read an answer from the file of its certificate, once the checker has accepted it.

    Parameters
    ----------
    path : path
    system : MultiChannelSystem or ParametricSystem, optional
        The plant that the certificate must be about, and may name by its digest.

    Raises
    ------
    InputError
        If the file is missing, unreadable or too large, or the certificate is not VALID.

    Notes
    -----
    A matrix without rows is written without its number of columns, and read with 0 columns.
    """
    with InputError.inside(place_of(path)):
        data = read_bytes(path)
    if system is not None and not isinstance(system, ParametricSystem):
        InputError.require(system, MultiChannelSystem, "system")
    plant = None if system is None else system.plant
    text = None if plant is None else plant.canonical_text()
    verdict = checked(data, plant=text)
    if verdict.verdict != "VALID":
        raise InputError(f"the checker does not accept it ({verdict.line()})", where=str(path))
    digits = sys.get_int_max_str_digits()
    try:
        # A certificate may contain longer numbers than the interpreter reads by default.
        sys.set_int_max_str_digits(0)
        return answer_of(json.loads(data), plant)
    finally:
        sys.set_int_max_str_digits(digits)


def answer_of(
    document: Mapping[str, Any], plant: MultiChannelSystem | ParametricSystem | None = None
) -> Answer:
    """Make the answer of a valid certificate's document, about the plant if it is given."""
    known: Any = _plant(document["system"]) if plant is None else plant
    about = constructed(known, document["subject"])
    return _answer(kind_named(document["kind"]), document, about)


def constructed(system: Any, subject: Sequence[Mapping[str, Any]]) -> Any:
    """Apply constructions, given as plain data of a certificate, to a plant."""
    if isinstance(system, ParametricSystem):
        if subject and subject[0]["construction"] == LINE:
            step, *subject = subject
            system = along_line(system, step["point"], step["direction"], step["parameter"])
        loop = [each["construction"] for each in subject[-1:]] == ["closed_loop"]
        apply = looped if loop else moved
        return apply(system, lambda plain: constructed(plain, subject)) if subject else system
    for construction in subject:
        system = _CONSTRUCTIONS[construction["construction"]](system, construction)
    return system


def _plant(document: Mapping[str, Any]) -> Any:
    text = canonical({"format": system_forms.FORMAT, **document})
    if "parameters" in document:
        return system_file.read_parametric_system(text, limits=_roomy(text))
    return system_file.read_system(text, limits=_roomy(text))


def _closed_loop(system: MultiChannelSystem, given: Mapping[str, Any]) -> MultiChannelSystem:
    text = canonical({"format": controller.FORMAT, "system": "", **given["controller"]})
    return closed_loop(system, controller.read_controller(text, _roomy(text))).system


def _roomy(text: str) -> Limits:
    """Limits for a text that was accepted already, which it cannot exceed."""
    digits = max(Limits.digits, len(text) + Limits.exponent)
    return Limits(bytes=max(Limits.bytes, len(text)), digits=digits)


def _gains(given: Mapping[str, Any], widths: list[int]) -> list[Matrix]:
    return [_matrix(F, ncols) for F, ncols in zip(given["gains"], widths, strict=True)]


_CONSTRUCTIONS: Mapping[
    str, Callable[[MultiChannelSystem, Mapping[str, Any]], MultiChannelSystem]
] = {
    "augmented_outputs": lambda system, _: augmented_outputs(system),
    "dual": lambda system, _: dual(system),
    "feedback": lambda system, given: feedback(
        system, _gains(given, [system.q(i) for i in range(system.m)])
    ),
    "full_output": lambda system, given: full_output(system, system.index(given["channel"])),
    "arcs": lambda system, given: add_links(
        system, [(system.index(j), system.index(i)) for j, i in given["added"]]
    ),
    "extended": lambda system, given: extended_system(system, given["dimensions"], given["share"]),
    "lifted": lambda system, given: lifted_system(system, given["dimensions"], given["share"]),
    "held": lambda system, given: held_system(system, given["dimensions"]),
    "integrators": lambda system, _: setpoint_system(system),
    "merged": lambda system, given: merged(system, given["parts"]),
    "restricted": lambda system, given: restricted(system, given["channels"]),
    "error": lambda system, given: error_system(system, _gains(given, [system.n] * system.m)),
    "closed_loop": _closed_loop,
}


def _answer(kind: type[Answer], document: Mapping[str, Any], about: Any) -> Answer:
    """Convert claim and witness to the fields of a kind of answer."""
    hints = typing.get_type_hints(kind)
    values = {}
    for role in ("claim", "witness"):
        for each in fields_of(kind, role):
            whole = each.metadata.get("whole")
            if is_optional(each) and key_of(each) not in document[role]:
                continue
            value = document[role] if whole else document[role][key_of(each)]
            values[each.name] = _value(hints[each.name], value, about)
    return kind(about, **values)


def _value(wanted: Any, value: Any, about: Any) -> Any:
    """Convert plain data to a value of a type."""
    arguments = typing.get_args(wanted)
    if isinstance(wanted, types.UnionType):
        [wanted] = [each for each in arguments if _could_be(each, value)]
        arguments = typing.get_args(wanted)
    if typing.get_origin(wanted) is tuple:
        each = [arguments[0]] * len(value) if arguments[-1] is Ellipsis else arguments
        return tuple(_value(t, v, about) for t, v in zip(each, value, strict=True))
    if wanted in _READ:
        return _READ[wanted](value)
    if isinstance(wanted, type) and is_dataclass(wanted):
        if issubclass(wanted, Answer):
            return _answer(wanted, value, about)
        hints = typing.get_type_hints(wanted)
        given = [f for f in fields(wanted) if key_of(f) in value or not is_optional(f)]
        return wanted(**{f.name: _value(hints[f.name], value[key_of(f)], about) for f in given})
    return value


def _could_be(wanted: Any, value: Any) -> bool:
    """Whether plain data have the form of one of several types."""
    if wanted is types.NoneType or value is None:
        return wanted is types.NoneType and value is None
    if is_dataclass(wanted) and wanted not in _READ and isinstance(value, dict):
        needed = {key_of(each) for each in fields(wanted) if not is_optional(each)}
        return needed <= value.keys() <= {key_of(each) for each in fields(wanted)}
    return True


def _matrix(value: Mapping[str, Any], ncols: int | None = None) -> Matrix:
    return Matrix.from_integers(value["entries"], value["denominator"], ncols)


def _polynomial_matrix(value: Mapping[str, Any]) -> PolynomialMatrix:
    d = value["denominator"]
    return PolynomialMatrix.from_matrices(
        *(Matrix.from_integers(layer, d) for layer in value["coefficients"])
    )


_READ: Mapping[Any, Callable[[Any], Any]] = {
    Fraction: Fraction,
    Polynomial: Polynomial.from_coefficients,
    Matrix: _matrix,
    PolynomialMatrix: _polynomial_matrix,
}
