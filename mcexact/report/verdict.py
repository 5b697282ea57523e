"""The independent checker, called on what this package made or on a file."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mcexact.certificate.evidence import Certificate
from mcexact.checker import Verdict, check_document
from mcexact.errors import InputError

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
