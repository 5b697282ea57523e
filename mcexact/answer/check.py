"""Verification by the checker, and answers read back from certificates.

`check` gives the verdict of the independent checker on one answer or file, in this process or, with
a limit on the time, in a child process that can be ended.  `recheck` verifies several certificates,
and the sentences of their manifest if there is one.

`load_certificate` makes an answer of a file once the checker has accepted it: the JSON is converted
field by field, by the types that the dataclass of its kind declares.
"""

from __future__ import annotations

import json
import os
import sys
import types
import typing
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from mcexact import checker
from mcexact.answer.protocol import Answer, fields_of, is_optional, key_of, kind_named
from mcexact.checker.command import NAME, plants_beside, verdicts_of
from mcexact.checker.core.reading import Limits as reading_Limits
from mcexact.checker.core.reading import Refused
from mcexact.checker.kinds import PLANT, Expectation, check_document
from mcexact.checker.kinds import Verdict as Found
from mcexact.derived.constructions import LINE as constructions_LINE
from mcexact.derived.constructions import (
    add_links,
    along_line,
    augmented_outputs,
    dual,
    error_system,
    extended_system,
    failed,
    feedback,
    full_output,
    held_system,
    internal_model,
    lifted_system,
    looped,
    merged,
    rearranged,
    regulated_outputs,
    restricted,
    servo_system,
    setpoint_system,
    slow_system,
)
from mcexact.derived.feedthrough import input_filters
from mcexact.derived.modulo import without_part
from mcexact.derived.sampling import sampled_system
from mcexact.errors import InputError, InternalError, place_of, require_seconds, telling
from mcexact.exact.linear_algebra import PolynomialMatrix
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import Limits as rational_Limits
from mcexact.model import controller, system_file
from mcexact.model import system as system_forms
from mcexact.model.loop import closed_loop
from mcexact.model.parametric import ParametricSystem
from mcexact.model.periodic import periodic_loop, phases_of
from mcexact.model.signals import followed_outputs
from mcexact.model.system import MultiChannelSystem, any_system
from mcexact.model.text import canonical, plain, read_bytes
from mcexact.processes import Child
from mcexact.shown import LINE as shown_LINE
from mcexact.shown import Shown, fitting

if TYPE_CHECKING:
    from mcexact.model.controller import Controller


# Verdicts.


@dataclass(frozen=True, repr=False)
class Verdict(Shown, checker.Verdict):
    """The verdict on one certificate: VALID, or why not.

    Attributes
    ----------
    verdict : str
        VALID, INVALID, NOT ABOUT, MALFORMED, INCOMPLETE, or ERROR for a bug in the checker.
    statement : str
        The theorem that was proved, in words; empty if the verdict is not VALID.
    statement_digest, system_digest, controller_digest : str
        The SHA-256 of the statement, of the plant, and of the controller if there is one.
    code, place, message : str
        If it is not VALID, a word for the reason, the place in the document, and a sentence.
    spent : int
        The units of work that the check took.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem, check, fixed_spectrum
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> check(fixed_spectrum(plant)).valid
    True
    >>> other = MultiChannelSystem([[2]], [[[1]]], [[[1]]])
    >>> print(check(fixed_spectrum(plant), other).explain())  # doctest: +ELLIPSIS
    NOT ABOUT system system: about another system, ...
    """

    @classmethod
    def of(cls, verdict: checker.Verdict) -> Verdict:
        """Make the verdict from that of the checker."""
        return cls(**vars(verdict))

    @property
    def valid(self) -> bool:
        """Whether the certificate is VALID, so that its statement is proved."""
        return self.verdict == "VALID"

    def explain(self) -> str:
        """Say what was proved, or why the certificate is not valid."""
        return self.statement if self.valid else self.line()

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the verdict with what it says."""
        yield "verdict", self.verdict
        for name in ("statement", "code", "place", "message"):
            if getattr(self, name):
                yield name, getattr(self, name)

    def to_dict(self) -> dict[str, Any]:
        """Return the verdict as plain data."""
        return dict(vars(self))

    def __repr__(self) -> str:
        words = f"VALID: {self.statement}" if self.valid else self.line()
        return fitting(f"Verdict({words}", shown_LINE - 1) + ")"


# Verification by the independent checker, of answers and of files.

_ACCEPTED = ("VALID", "IMPLIED", "REMARK", "INCOMPLETE")


def check(
    certificate: Answer | str | os.PathLike[str],
    system: MultiChannelSystem | ParametricSystem | None = None,
    controller: Controller | str | os.PathLike[str] | None = None,
    expect: str | Mapping[str, Any] | None = None,
    *,
    timeout: float | None = None,
    progress: Callable[[str], None] | None = None,
) -> Verdict:
    """Check a certificate with the independent checker.

    Parameters
    ----------
    certificate : Answer or path
        An answer, or the file of its certificate.
    system : MultiChannelSystem or ParametricSystem, optional
        The plant that the certificate must be about, and may name by its digest; with a derived
        system, the certificate must be about this system, or with a controller about its closed
        loop.
    controller : Controller or path, optional
        The controller of the closed loop that the certificate must be about, or its file.  Nothing
        but the plant is in the loop, unless ``system`` or ``expect`` says so.
    expect : str or mapping, optional
        The statement that the certificate must make, its SHA-256, the line of its verdict, or a
        claim ``{"kind": …, "claim": …}`` as in the certificate.  Such a claim is about ``system``,
        or else about the plant itself; the key ``"subject"`` names other constructions.
    timeout : float, optional
        Seconds after which the verdict is INCOMPLETE.  The check then runs in a separate process.
    progress : callable, optional
        It is called with a line of text before the certificate is read and checked.

    Returns
    -------
    Verdict
        Whether it is ``valid``: its ``verdict`` is VALID, INVALID, NOT ABOUT, MALFORMED or
        INCOMPLETE.  ``statement`` is the verified statement; ``code``, ``place`` and ``message``
        say why a certificate is not valid.

    Raises
    ------
    InputError
        If a file is missing, unreadable, malformed or too large, or an argument has another type.
    UsageError
        If ``timeout`` is no number of seconds, or ``progress`` no function.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem, fixed_spectrum
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> check(fixed_spectrum(plant), plant).verdict
    'VALID'
    >>> other = MultiChannelSystem([[2]], [[[1]]], [[[1]]])
    >>> check(fixed_spectrum(plant), other).verdict
    'NOT ABOUT'
    >>> check(fixed_spectrum(plant), expect={"kind": "completeness", "claim": {}}).message
    'a claim of another kind, fixed_spectrum'
    >>> check({})
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: certificate: expected an answer, such as \
fixed_spectrum(system), or the name of a certificate file, found dict
    """
    from mcexact.model.parametric import ParametricSystem
    from mcexact.model.text import plain

    tell = telling(progress)
    if timeout is not None:
        require_seconds(timeout, "timeout")
    if system is not None and not isinstance(system, ParametricSystem):
        any_system(system)
    wanted = Expectation() if system is None else about_plant(system.canonical_text())
    if system is not None and system.subject:
        wanted = replace(wanted, subject=json.loads(json.dumps(plain(system.subject))))
    if controller is not None:
        wanted = _asked("controller", wanted.controlled, _controller(controller))
    if expect is not None:
        wanted = _asked("expect", wanted.saying, _expected(expect))
    tell("reading the certificate")
    text, file = _text(certificate), None
    if not isinstance(certificate, Answer):
        file = os.fspath(certificate)
    tell(f"checking a certificate of {len(text):,} bytes")
    if timeout is None:
        return Verdict.of(_checked_beside(text, wanted, file))
    return Verdict.of(_in_time(text, wanted, file, timeout))


def _checked_beside(text: bytes, wanted: Expectation, file: str | None) -> Found:
    """The verdict on a certificate, which may name a plant in the folder of its file."""
    limits = reading_Limits()
    beside = None if file is None else plants_beside(file, limits)
    return check_document(text, wanted, limits, beside)


def _in_time(text: bytes, wanted: Expectation, file: str | None, seconds: float) -> Found:
    """The verdict of a child process, or INCOMPLETE when the time is over."""
    child = Child(_check_in_child, (text, wanted, file))
    try:
        if not child.connection.poll(seconds):
            message = f"not decided after {seconds:g} s (timeout= allows more)"
            return Found("INCOMPLETE", code="time", place="checker", message=message)
        verdict: Found = child.connection.recv()
    except (EOFError, OSError):
        message = f"the process that checks ended with status {child.exit_status()}"
        return Found("INCOMPLETE", code="memory", place="checker", message=message)
    finally:
        child.end()
    return verdict


def _check_in_child(connection: Any, text: bytes, wanted: Expectation, file: str | None) -> None:
    connection.send(_checked_beside(text, wanted, file))


def _asked(
    where: str, ask: Callable[[bytes, reading_Limits], Expectation], data: bytes
) -> Expectation:
    """The expectation that a text expresses, or an input error that names the argument."""
    try:
        # A file may come from anybody, so the work that it requests is bounded as on the command
        # line.
        return ask(data, replace(_limits(len(data)), work=None))
    except Refused as refused:
        raise InputError(refused.message, where=f"{where}: {refused.place}") from None


def _expected(expect: Any) -> bytes:
    """The bytes of what a certificate is expected to say."""
    if not isinstance(expect, Mapping):
        InputError.require(expect, str, "expect")
        return str(expect).encode(errors="surrogatepass")
    try:
        return json.dumps(dict(expect)).encode("ascii")
    except (TypeError, ValueError, RecursionError) as error:
        raise InputError(f"expected JSON: {error}", where="expect") from None


def _controller(controller: Any) -> bytes:
    """The bytes of a controller's file."""
    from mcexact.model.controller import Controller, controller_text
    from mcexact.model.text import read_bytes

    if isinstance(controller, Controller):
        return controller_text(controller).encode("ascii")
    if not isinstance(controller, str | os.PathLike):
        InputError.require(controller, Controller, "controller")
    with InputError.inside(place_of(controller)):
        return read_bytes(controller)


def about_plant(text: str) -> Expectation:
    """The expectation that a certificate is about a plant, which it may name by its digest.

    Parameters
    ----------
    text : str
        The plant as the ``system`` object of a certificate.
    """
    from mcexact.model.text import numbers_of_any_length, sha256

    with numbers_of_any_length():
        plant = json.loads(text)
    return Expectation(system=sha256(text), plant=plant, size=len(text))


def recheck(
    files: Mapping[str, str],
    plant: str | Mapping[str, str],
    each: Callable[[str, Found], None] | None = None,
) -> dict[str, Found]:
    """Verify certificates, and the sentences of their manifest.

    Parameters
    ----------
    files : mapping from names to texts
        Certificates, the plants that they name, and perhaps a manifest, whose sentences are then
        verified.
    plant : str or mapping
        The plant as the ``system`` object of a certificate; or such a text for each file, where
        that of the manifest is the plant of its sentences.
    each : callable, optional
        It is called with the name of a file and its verdict as soon as this is known.

    Returns
    -------
    dict from names to Verdict
        The verdict on each file: VALID, or INCOMPLETE if a limit of the checker was reached.

    Raises
    ------
    InternalError
        If a certificate is rejected, or a sentence is not implied, so that no answer of this run
        can be trusted.
    """
    size, verdicts = max(map(len, files.values()), default=0), {}
    for about, verdict in _verdicts(files, plant, _limits(size)):
        if verdict.verdict not in _ACCEPTED or verdict.code == "rule":
            what = about.get("file") or about["text"]
            raise InternalError(
                f"the independent checker does not accept {what} ({verdict.line()}): "
                "the answers of this run cannot be trusted"
            )
        if "file" in about:
            verdicts[about["file"]] = verdict
            if each is not None:
                each(about["file"], verdict)
    return verdicts


def _verdicts(
    files: Mapping[str, str], plant: str | Mapping[str, str], limits: reading_Limits
) -> Iterator[tuple[dict[str, str], Found]]:
    """Return the verdicts on the certificates and on the sentences of the manifest."""
    plants = dict.fromkeys(files, plant) if isinstance(plant, str) else plant
    listed: set[str] = set()

    def beside(digest: str) -> bytes | None:
        text = files.get(f"{digest}{PLANT}")
        return None if text is None else text.encode("ascii")

    if NAME in files:
        listed = {NAME, *json.loads(files[NAME])["certificates"]}
        known = about_plant(plants[NAME])
        yield from verdicts_of(lambda name: files[name or NAME].encode(), known, limits, beside)
    for name, text in files.items():
        if name not in listed and not name.endswith(PLANT):
            expected = about_plant(plants[name])
            verdict = check_document(text.encode("ascii"), expected, limits, beside)
            yield {"file": name}, verdict


def _limits(size: int) -> reading_Limits:
    """Limits that allow texts of this size, with numbers of any length, and any work.

    No limit is needed: finding this evidence took this program longer than checking it does.
    """
    limits = {"bytes": max(reading_Limits.bytes, size), "digits": max(reading_Limits.digits, size)}
    return reading_Limits(**limits, work=10**30)


def checked(
    data: bytes, system_digest: str = "", plant: str | None = None, file: str | None = None
) -> Found:
    """Return the checker's verdict on the text of a certificate of any length.

    Parameters
    ----------
    data : bytes
    system_digest : str
        The digest of the plant that it must be about; empty for any.
    plant : str, optional
        In place of the digest, the plant as the ``system`` object of a certificate.
    file : str, optional
        The file of the certificate, in whose folder that of its plant may be.
    """
    expected = Expectation(system=system_digest) if plant is None else about_plant(plant)
    limits = _limits(len(data))
    beside = None if file is None else plants_beside(file, limits)
    return check_document(data, expected, limits, beside)


def _text(certificate: Any) -> bytes:
    """Read the bytes of a certificate's file."""
    if isinstance(certificate, str | os.PathLike):
        from mcexact.model.text import read_bytes

        with InputError.inside(place_of(certificate)):
            return read_bytes(certificate)
    if not isinstance(certificate, Answer):
        several = {"certificates": ".certificates.values()", "decided": ".decided().values()"}
        held = [path for name, path in several.items() if hasattr(certificate, name)]
        raise InputError(
            "expected an answer, such as fixed_spectrum(system), or the name of a certificate "
            f"file, found {type(certificate).__name__}"
            + "".join(f"; check each of its {path}" for path in held[:1]),
            where="certificate",
        )
    from mcexact.answer import protocol

    return protocol.encode(certificate).encode("ascii")


# Reading answers from certificates, according to the types of their fields.


def load_certificate(
    path: str | os.PathLike[str], system: MultiChannelSystem | ParametricSystem | None = None
) -> Answer:
    """Read an answer from the file of its certificate, once the checker has accepted it.

    Parameters
    ----------
    path : path
    system : MultiChannelSystem or ParametricSystem, optional
        The plant that the certificate must be about, and may name by its digest; one that is named
        by its digest may also have its file beside the certificate.

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
        any_system(system)
    plant = None if system is None else system.plant
    text = None if plant is None else plant.canonical_text()
    file = os.fspath(path)
    verdict = checked(data, plant=text, file=file)
    if verdict.verdict != "VALID":
        raise InputError(f"the checker does not accept it ({verdict.line()})", where=str(path))
    return answer_in(file, data, system)


def answer_in(
    file: str, data: bytes, system: MultiChannelSystem | ParametricSystem | None = None
) -> Answer:
    """Make the answer from the bytes of a certificate that the checker has accepted.

    Parameters
    ----------
    file : str
        Where the certificate is; its plant may be beside it.
    data : bytes
    system : MultiChannelSystem or ParametricSystem, optional
        Its plant, instead of the one that it contains or that is beside it.
    """
    digits = sys.get_int_max_str_digits()
    try:
        # A certificate may contain longer numbers than the interpreter reads by default.
        sys.set_int_max_str_digits(0)
        document = json.loads(data)
        plant = None if system is None else system.plant
        if plant is None and isinstance(document["system"], str):
            beside = plants_beside(file, _limits(len(data)))(document["system"])
            document["system"] = json.loads(beside or b"")
        return answer_of(document, plant)
    finally:
        sys.set_int_max_str_digits(digits)


def answer_of(
    document: Mapping[str, Any], plant: MultiChannelSystem | ParametricSystem | None = None
) -> Answer:
    """Make the answer from a valid certificate's document, about `plant` or the document's own."""
    known: Any = _plant(document["system"]) if plant is None else plant
    about = constructed(known, document["subject"])
    return _answer(kind_named(document["kind"]), document, about)


def constructed(system: Any, subject: Sequence[Mapping[str, Any]]) -> Any:
    """Apply constructions, in the plain data of a certificate, to a plant."""
    if isinstance(system, ParametricSystem):
        if subject and subject[0]["construction"] == constructions_LINE:
            step, *subject = subject
            system = along_line(system, step["point"], step["direction"], step["parameter"])
        loop = [each["construction"] for each in subject[-1:]] == ["closed_loop"]
        apply = looped if loop else rearranged
        return apply(system, lambda plain: constructed(plain, subject)) if subject else system
    for construction in subject:
        system = _CONSTRUCTIONS[construction["construction"]](system, construction)
    return system


def _plant(document: Mapping[str, Any]) -> Any:
    text = canonical({"format": system_forms.FORMAT, **document})
    if "parameters" in document:
        return system_file.read_parametric_system(text, limits=_roomy(text))
    return system_file.read_system(text, limits=_roomy(text))


def controller_of_loop(document: Mapping[str, Any]) -> controller.Controller:
    """Read a controller from the plain data of a certificate."""
    text = canonical({"format": controller.FORMAT, "system": "", **document})
    return controller.read_controller(text, _roomy(text))


def followed_in(loop: Answer) -> dict[str, Any]:
    """What a rule repeats of the signals that outputs follow, from a certificate about a loop.

    Returns
    -------
    dict
        ``follows``, as from `followed_outputs` for the regulated outputs of the plant, or for all
        if it names none; ``outputs``, the numbers of outputs by agent, in the second case alone.
        Nothing is in it for other systems than the loop of a time-invariant controller.
    """
    if [each["construction"] for each in loop.subject[-1:]] != ["closed_loop"]:
        return {}
    *made, step = loop.subject
    system = constructed(loop.about.plant, [plain(each) for each in made])
    agents = controller_of_loop(step["controller"])
    each = [(name, system.q(i)) for i, name in enumerate(system.names)]
    counts = [] if system.regulated else each
    selection = system.regulated or tuple(Matrix.identity(q) for _, q in counts)
    return {
        "follows": followed_outputs(agents, selection),
        "outputs": [(name, q) for name, q in counts if q],
    }


def _closed_loop(system: MultiChannelSystem, construction: Mapping[str, Any]) -> MultiChannelSystem:
    return closed_loop(system, controller_of_loop(construction["controller"])).system


def _periodic_loop(
    system: MultiChannelSystem, construction: Mapping[str, Any]
) -> MultiChannelSystem:
    phases = construction["phases"]
    return periodic_loop(system, phases_of(phases, limits=_roomy(canonical(phases))))


def _roomy(text: str) -> rational_Limits:
    """Limits for a text that was accepted already, which it cannot exceed."""
    digits = max(rational_Limits.digits, len(text) + rational_Limits.exponent)
    return rational_Limits(bytes=max(rational_Limits.bytes, len(text)), digits=digits)


def _gains(construction: Mapping[str, Any], widths: list[int]) -> list[Matrix]:
    return [_matrix(F, ncols) for F, ncols in zip(construction["gains"], widths, strict=True)]


_CONSTRUCTIONS: Mapping[
    str, Callable[[MultiChannelSystem, Mapping[str, Any]], MultiChannelSystem]
] = {
    "augmented_outputs": lambda system, _: augmented_outputs(system),
    "dual": lambda system, _: dual(system),
    "feedback": lambda system, data: feedback(
        system, _gains(data, [system.q(i) for i in range(system.m)])
    ),
    "full_output": lambda system, data: full_output(system, system.index(data["channel"])),
    "arcs": lambda system, data: add_links(
        system, [(system.index(j), system.index(i)) for j, i in data["added"]]
    ),
    "extended": lambda system, data: extended_system(system, data["dimensions"], data["share"]),
    "failed": lambda system, data: failed(
        system, **{what: data[what] for what in ("agents", "actuators", "sensors", "links")}
    ),
    "lifted": lambda system, data: lifted_system(system, data["dimensions"], data["share"]),
    "held": lambda system, data: held_system(system, data["dimensions"]),
    "input_filters": lambda system, _: input_filters(system),
    "integrators": lambda system, _: setpoint_system(system),
    "internal_model": lambda system, data: internal_model(
        system,
        Polynomial.from_coefficients(map(Fraction, data["polynomial"])),
        _gains(data, [system.q(i) for i in range(system.m)]),
    ),
    "merged": lambda system, data: merged(system, data["parts"]),
    "modulo": lambda system, data: without_part(
        system, data["part"], _matrix(data["annihilator"], system.n), data["pivots"]
    ),
    "regulated": lambda system, data: regulated_outputs(
        system, _gains(data, [system.q(i) for i in range(system.m)])
    ),
    "restricted": lambda system, data: restricted(system, data["channels"]),
    "sampled": lambda system, data: sampled_system(
        system, Fraction(data["step"]), data["late"], decimals=data["decimals"]
    ),
    "servo": lambda system, data: servo_system(
        system, _gains(data, [system.q(i) for i in range(system.m)])
    ),
    "slow": lambda system, data: slow_system(system, data["window"]),
    "error": lambda system, data: error_system(system, _gains(data, [system.n] * system.m)),
    "closed_loop": _closed_loop,
    "periodic_loop": _periodic_loop,
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
        present = [f for f in fields(wanted) if key_of(f) in value or not is_optional(f)]
        return wanted(**{f.name: _value(hints[f.name], value[key_of(f)], about) for f in present})
    return value


def _could_be(wanted: Any, value: Any) -> bool:
    """Whether plain data have the form of one of several types."""
    if wanted is types.NoneType or value is None:
        return wanted is types.NoneType and value is None
    if is_dataclass(wanted) and wanted not in _READ and isinstance(value, dict):
        needed = {key_of(each) for each in fields(wanted) if not is_optional(each)}
        return needed <= value.keys() <= {key_of(each) for each in fields(wanted)}
    if wanted is int:
        return isinstance(value, int)
    if typing.get_origin(wanted) is tuple:
        (first, *_), known = typing.get_args(wanted), isinstance(value, list)
        return known and all(_could_be(first, each) for each in value[:1])
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
