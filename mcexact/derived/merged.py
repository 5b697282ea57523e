"""The plant with some of its channels merged."""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence

from mcexact.arguments import several
from mcexact.errors import InputError, UsageError
from mcexact.model.names import quoted
from mcexact.model.system import MultiChannelSystem


def merged(system: MultiChannelSystem, parts: Sequence[Sequence[str]]) -> MultiChannelSystem:
    """Merge the channels of each part into one channel.

    Parameters
    ----------
    system : MultiChannelSystem
    parts : sequence of sequences of str
        The names of the channels of each part; every channel is in exactly one part.

    Returns
    -------
    MultiChannelSystem
        (A, B_T, C_T), one channel for each part T, in the order of first members, without a
        neighbor graph.  A channel of several members has their names, joined by "+".

    Raises
    ------
    UsageError
        If a part is empty, a name is unknown, the parts are not a partition of the channels, or two
        of the new channels would have the same name.

    Notes
    -----
    In block form, for a part T = {i, j, …} with i < j < …::

        B_T = [ B_i  B_j  … ]    n×(p_i + p_j + …)

              ⎡ C_i ⎤
        C_T = ⎢ C_j ⎥            (q_i + q_j + …)×n
              ⎣  ⋮  ⎦

    Gains of the plant are block diagonal gains of the result, so that merging adds no fixed mode.
    With all channels in one part, the fixed modes are the modes that all channels together do not
    control or do not observe.

    With the strong components of the plant's transfer graph as parts, the fixed modes of the
    result are those that no decentralized controller of the plant moves, not even one that varies
    with time or is nonlinear; some such controller stabilizes the plant iff they are all stable.
    This theorem is cited (Anderson and Moore 1981; Gong and Aldeen 1997) and claimed by no
    certificate: a certificate claims what the fixed modes of the result are, and no more.

    Examples
    --------
    >>> from mcexact import fixed_spectrum, transfer_graph
    >>> from mcexact.model import gallery
    >>> plant = gallery.load("movable-by-periodic-gains")
    >>> as_one = merged(plant, transfer_graph(plant).components)
    >>> as_one.names, as_one.B(0).numerators
    (('1+2',), ((1, 0), (0, 6), (0, -11)))
    >>> str(fixed_spectrum(plant).polynomial), str(fixed_spectrum(as_one).polynomial)
    ('x - 11/10', '1')
    >>> merged(plant, [["1"]])
    Traceback (most recent call last):
        ...
    mcexact.errors.UsageError: parts: expected every channel in exactly one part, found '2' 0 times
    """
    InputError.require(system, MultiChannelSystem, "system")
    parts = several(parts, "parts", "lists of names")
    found = sorted(system.indices(part) for part in parts)
    if () in found:
        raise UsageError("expected at least one channel in every part, found none", where="parts")
    given = [name for part in parts for name in part]
    for name in system.names:
        if given.count(name) != 1:
            raise UsageError(
                "expected every channel in exactly one part, "
                f"found {quoted(name)} {given.count(name)} times",
                where="parts",
            )
    listed = [list(system.named(part)) for part in found]
    names = ["+".join(part) for part in listed]
    forms = [unicodedata.normalize("NFC", name) for name in names]
    for name, form in zip(names, forms, strict=True):
        if forms.count(form) > 1:
            raise UsageError(f"two channels would have the name {quoted(name)}", where="parts")
    return system.derived(
        system.A,
        [system.input_matrix(part) for part in found],
        [system.output_matrix(part) for part in found],
        {"construction": "merged", "parts": listed},
        names=names,
    )
