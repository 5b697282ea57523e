"""The independent checker, called on what this package made or on a file."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mcexact.certificate.evidence import Certificate
from mcexact.checker import Limits, Verdict, check_document
from mcexact.errors import InputError, InternalError

if TYPE_CHECKING:
    from mcexact.model.system import MultiChannelSystem


def check(
    certificate: Certificate | str | os.PathLike[str],
    system: MultiChannelSystem | None = None,
) -> Verdict:
    """Check a certificate with the independent checker.

    Parameters
    ----------
    certificate : Certificate or path
        A result's ``certificate``, or a file.
    system : MultiChannelSystem, optional
        The plant that the certificate must be about.

    Returns
    -------
    Verdict
        Its ``verdict`` is VALID, INVALID, MALFORMED or INCOMPLETE; ``theorem`` says what was
        checked; ``code``, ``place`` and ``message`` say why it is not valid.

    Raises
    ------
    InputError
        If the file is missing, unreadable or too large, or one of the arguments is something else.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem, fixed_spectrum
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> check(fixed_spectrum(plant).certificate, plant).verdict
    'VALID'
    >>> other = MultiChannelSystem([[2]], [[[1]]], [[[1]]])
    >>> check(fixed_spectrum(plant).certificate, other).verdict
    'INVALID'
    >>> check({})
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: certificate: expected a certificate, such as \
fixed_spectrum(system).certificate, or the name of a file, found dict
    """
    from mcexact.model.system import MultiChannelSystem
    from mcexact.model.system_file import digest

    if system is not None and not isinstance(system, MultiChannelSystem):
        raise InputError(
            f"expected a MultiChannelSystem, found {type(system).__name__}", where="system"
        )
    expected = None if system is None else digest(system.plant)
    return check_document(_text(certificate), expected)


def recheck(certificates: Mapping[str, str], system_digest: str) -> dict[str, Verdict]:
    """What the independent checker says of certificates about one plant.

    Parameters
    ----------
    certificates : mapping from names to texts
    system_digest : str

    Returns
    -------
    dict from names to Verdict
        Each is VALID, or INCOMPLETE where a limit of the checker was reached.

    Raises
    ------
    InternalError
        If a certificate is not accepted: then no answer of this run is to be believed.
    """
    verdicts = {}
    for name, text in certificates.items():
        data = text.encode("ascii")
        size = len(data)
        limits = Limits(bytes=max(Limits.bytes, size), digits=max(Limits.digits, size))
        found = check_document(data, system_digest, limits)
        if found.verdict not in {"VALID", "INCOMPLETE"}:
            raise InternalError(
                f"the independent checker does not accept {name} ({found.line()}): "
                "the answers of this run are not to be believed"
            )
        verdicts[name] = found
    return verdicts


def _text(certificate: Any) -> bytes:
    """The bytes of the certificate's file."""
    if isinstance(certificate, str | os.PathLike):
        from mcexact.model.json_text import read_bytes

        try:
            return read_bytes(Path(certificate))
        except InputError as error:
            raise error.within(str(certificate)) from None
    if not isinstance(certificate, Certificate):
        raise InputError(
            "expected a certificate, such as fixed_spectrum(system).certificate, or the name of a "
            f"file, found {type(certificate).__name__}",
            where="certificate",
        )
    from mcexact.certificate import codec

    return codec.encode(certificate).encode("ascii")
