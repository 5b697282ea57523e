"""Verification by the independent checker, of answers and of files."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from mcexact.answer.protocol import Answer
from mcexact.answer.verdict import Verdict
from mcexact.checker import Expectation, Limits, check_document
from mcexact.checker import Verdict as Found
from mcexact.checker.manifest import NAME, verdicts_of
from mcexact.checker.reading import Refused
from mcexact.errors import InputError, InternalError, place_of, require_seconds, telling
from mcexact.processes import Child

if TYPE_CHECKING:
    from mcexact.model.controller import Controller
    from mcexact.model.parametric import ParametricSystem
    from mcexact.model.system import MultiChannelSystem


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
        Seconds after which the verdict is INCOMPLETE.  A process of its own checks then.
    progress : callable, optional
        It is called with a line of text before the certificate is read and checked.

    Returns
    -------
    Verdict
        Whether it is ``valid``: its ``verdict`` is VALID, INVALID, MALFORMED or INCOMPLETE.
        ``statement`` is the verified statement; ``code``, ``place`` and ``message`` say why a
        certificate is not valid.

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
    'INVALID'
    >>> check(fixed_spectrum(plant), expect={"kind": "completeness", "claim": {}}).message
    'a claim of another kind, fixed_spectrum'
    >>> check({})
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: certificate: expected an answer, such as \
fixed_spectrum(system), or the name of a certificate file, found dict
    """
    from mcexact.model.parametric import ParametricSystem
    from mcexact.model.system import MultiChannelSystem
    from mcexact.model.text import plain

    tell = telling(progress)
    if timeout is not None:
        require_seconds(timeout, "timeout")
    if system is not None and not isinstance(system, ParametricSystem):
        InputError.require(system, MultiChannelSystem, "system")
    wanted = Expectation() if system is None else about_plant(system.canonical_text())
    if system is not None and system.subject:
        wanted = replace(wanted, subject=json.loads(json.dumps(plain(system.subject))))
    if controller is not None:
        wanted = _asked("controller", wanted.controlled, _controller(controller))
    if expect is not None:
        wanted = _asked("expect", wanted.saying, _expected(expect))
    tell("reading the certificate")
    text = _text(certificate)
    tell(f"checking a certificate of {len(text):,} bytes")
    if timeout is None:
        return Verdict.of(check_document(text, wanted))
    return Verdict.of(_in_time(text, wanted, timeout))


def _in_time(text: bytes, wanted: Expectation, seconds: float) -> Found:
    """The verdict of a child process, or INCOMPLETE when the time is over."""
    child = Child(_check_in_child, (text, wanted))
    try:
        if not child.connection.poll(seconds):
            message = f"not decided after {seconds:g} s (timeout= allows more)"
            return Found("INCOMPLETE", code="time", place="checker", message=message)
        found: Found = child.connection.recv()
    except (EOFError, OSError):
        message = f"the process that checks ended with status {child.exit_status()}"
        return Found("INCOMPLETE", code="memory", place="checker", message=message)
    finally:
        child.end()
    return found


def _check_in_child(connection: Any, text: bytes, wanted: Expectation) -> None:
    connection.send(check_document(text, wanted))


def _asked(where: str, ask: Callable[[bytes, Limits], Expectation], data: bytes) -> Expectation:
    """What a text asks of the certificate."""
    try:
        # What a file asks may come from anybody: its work is bounded as on the command line.
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
    """What is asked of a certificate about a plant, which it may name by its digest.

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
        Certificates, and perhaps a manifest, whose sentences are then verified.
    plant : str or mapping
        The plant as the ``system`` object of a certificate; or of each file its own, that of the
        manifest being the one of its sentences.
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
    for about, found in _verdicts(files, plant, _limits(size)):
        if found.verdict not in _ACCEPTED or found.code == "rule":
            [what] = about.values()
            raise InternalError(
                f"the independent checker does not accept {what} ({found.line()}): "
                "the answers of this run cannot be trusted"
            )
        if "file" in about:
            verdicts[about["file"]] = found
            if each is not None:
                each(about["file"], found)
    return verdicts


def _verdicts(
    files: Mapping[str, str], plant: str | Mapping[str, str], limits: Limits
) -> Iterator[tuple[dict[str, str], Found]]:
    """Return the verdicts on the certificates and on the sentences of the manifest."""
    plants = dict.fromkeys(files, plant) if isinstance(plant, str) else plant
    listed: set[str] = set()
    if NAME in files:
        listed = {NAME, *json.loads(files[NAME])["certificates"]}
        known = about_plant(plants[NAME])
        yield from verdicts_of(lambda name: files[name or NAME].encode(), known, limits)
    for name in (name for name in files if name not in listed):
        expected = about_plant(plants[name])
        yield {"file": name}, check_document(files[name].encode("ascii"), expected, limits)


def _limits(size: int) -> Limits:
    """Limits that allow texts of this size, with numbers of any length, and any work.

    What this program has found took more work than the check of it, which may take as long.
    """
    limits = {"bytes": max(Limits.bytes, size), "digits": max(Limits.digits, size)}
    return Limits(**limits, work=10**30)


def checked(data: bytes, system_digest: str = "", plant: str | None = None) -> Found:
    """Return the checker's verdict on the text of a certificate of any length.

    Parameters
    ----------
    data : bytes
    system_digest : str
        The digest of the plant that it must be about; empty for any.
    plant : str, optional
        In place of the digest, the plant as the ``system`` object of a certificate.
    """
    expected = Expectation(system=system_digest) if plant is None else about_plant(plant)
    return check_document(data, expected, _limits(len(data)))


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
    from mcexact.answer import codec

    return codec.encode(certificate).encode("ascii")
