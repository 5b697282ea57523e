"""Every decision of the spine beside the oracle's; run as a module for as many systems as wanted.

python -m tests.oracle.agreement 10000
"""

from __future__ import annotations

import random
import sys
from collections.abc import Iterable
from typing import Any

from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.analysis.fixed_modes import completeness, fixed_spectrum, pencil_rank
from mcexact.analysis.sharing import deficiency
from mcexact.analysis.structure import transfer_graph
from mcexact.answer import protocol
from mcexact.answer.modes import FixedSpectrum
from mcexact.checker.kinds import check_document
from mcexact.model.system import MultiChannelSystem
from tests.oracle import enumeration as oracle
from tests.oracle.draws import exact, sparse_system
from tests.oracle.enumeration import PlainSystem


def drawn_pair(seed: int) -> tuple[PlainSystem, MultiChannelSystem]:
    """The system of a seed, in both forms."""
    rng = random.Random(seed)
    found = sparse_system(rng)
    return found, exact(found, rng.choice(["continuous", "discrete"]))


def fixed_factors(
    small: PlainSystem, system: MultiChannelSystem, spectrum: FixedSpectrum
) -> list[str]:
    wanted = {
        p: (found.rank, system.named(found.channels), found.multiplicity_in_A)
        for p, found in oracle.fixed_factors(small).items()
    }
    given = {
        f.polynomial.coefficients: (f.rank, f.channels, f.multiplicity_in_A)
        for f in spectrum.factors
    }
    problems = [] if given == wanted else [f"fixed factors {given}, enumeration says {wanted}"]
    for p, factor in zip(given, spectrum.factors, strict=True):
        least = oracle.least_multiplicity(small, p)
        if factor.multiplicity_at_most != least:
            problems.append(
                f"multiplicity {factor.multiplicity_at_most}, drawn gains reach {least}"
            )
    return problems


def _other_answers(
    small: PlainSystem, system: MultiChannelSystem, answers: dict[str, Any], fixed: bool
) -> Iterable[str]:
    arcs = oracle.transfer_arcs(small)
    components = oracle.strong_components(small.m, arcs)
    pairs = {
        "controllable dimension": (
            answers["controllability"].dimension,
            oracle.controllable_dimension(small),
        ),
        "dimension that channel 1 controls": (
            answers["one channel"].dimension,
            oracle.controllable_dimension(small, [0]),
        ),
        "observable dimension": (
            answers["observability"].dimension,
            oracle.controllable_dimension(small.dual),
        ),
        "arcs": (
            [system.indices([j]) + system.indices([i]) for j, i in answers["graph"].arcs],
            arcs,
        ),
        "components": (
            [list(system.indices(c)) for c in answers["graph"].components],
            components,
        ),
        "complete": (answers["completeness"].complete, len(components) == 1 and not fixed),
        "deficiency": (answers["deficiency"].deficiency, oracle.deficiency(small)),
    }
    for what, (given, wanted) in pairs.items():
        if given != wanted:
            yield f"{what} {given}, enumeration says {wanted}"


def disagreements(
    small: PlainSystem, system: MultiChannelSystem, *, certificates: bool = True
) -> tuple[list[str], bool]:
    """What differs from the oracle or is not VALID, and whether there are fixed modes."""
    spectrum = fixed_spectrum(system)
    problems = fixed_factors(small, system, spectrum)
    answers: dict[str, Any] = {
        "spectrum": spectrum,
        "completeness": completeness(system, spectrum=spectrum),
        "controllability": joint_controllability(system),
        "one channel": joint_controllability(system, system.names[:1]),
        "observability": joint_observability(system),
        "graph": transfer_graph(system),
        "deficiency": deficiency(system),
    }
    problems += _other_answers(small, system, answers, not spectrum.empty)
    for factor in spectrum.factors:
        s = system.names[::2]
        answers[f"pencil {factor.polynomial}"] = found = pencil_rank(system, s, factor.polynomial)
        wanted = oracle.pencil_rank(small, system.indices(s), factor.polynomial.coefficients)
        if found.rank != wanted:
            problems.append(f"pencil rank {found.rank}, enumeration says {wanted}")
    for name, answer in answers.items() if certificates else ():
        verdict = check_document(protocol.encode(answer).encode())
        if verdict.verdict != "VALID":
            problems.append(f"the certificate of {name} is {verdict}")
    return problems, not spectrum.empty


def main(count: int) -> int:
    """Compare ``count`` systems; print how many had fixed modes and where answers differ."""
    fixed = wrong = 0
    for seed in range(count):
        problems, has_fixed = disagreements(*drawn_pair(seed))
        fixed += has_fixed
        wrong += bool(problems)
        for problem in problems:
            print(f"system {seed}: {problem}")
        if (seed + 1) % 1000 == 0:
            print(f"{seed + 1} systems, {fixed} with fixed modes, {wrong} differ", flush=True)
    print(f"{count} systems, {fixed} with fixed modes, {wrong} differ")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1])))
