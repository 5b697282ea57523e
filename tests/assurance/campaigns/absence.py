"""Both proofs that no more is fixed, on drawn systems, beside enumeration over all subsets.

Run as ``python -m tests.assurance.campaigns.absence [COUNT [FILE]]``.  What is in the file (by
default ``build/absence.jsonl``) is not tried again: after an interruption the same command goes on.
At the end it counts which proof was found, for the drawn systems and for those of the gallery.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from pathlib import Path
from typing import Any
from unittest import mock

from mcexact.analysis import fixed_modes as module
from mcexact.analysis.blocks import bounded_blocks, modes_left, state_blocks
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.answer.evidence import Block, CoprimePolynomials
from mcexact.answer.modes import ByBlocks, FixedSpectrum, TwoPolynomials
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.model import gallery
from mcexact.model.system import MultiChannelSystem
from tests.oracle.agreement import drawn_pair, fixed_factors
from tests.oracle.enumeration import PlainSystem

FILE = Path("build") / "absence.jsonl"


def without_sequences(system: MultiChannelSystem) -> FixedSpectrum:
    """The answer with two polynomials of the whole as evidence."""
    one = (Block(tuple(range(system.n)), None),)
    with mock.patch.object(module, "bounded_blocks", return_value=one):
        found = fixed_spectrum(system)
    assert isinstance(found.evidence, TwoPolynomials) or not system.n or _all_fixed(found)
    return found


def _all_fixed(spectrum: FixedSpectrum) -> bool:
    """Whether the factors are all n modes, which needs no evidence."""
    n = spectrum.about.n
    return sum((n - f.rank) * f.polynomial.degree for f in spectrum.factors) == n


def evidence_of(system: MultiChannelSystem, spectrum: FixedSpectrum) -> str:
    """Which proof was found, in words."""
    connected = "one block" if len(state_blocks(system)) < 2 else "several blocks"
    fixed = "nothing fixed" if spectrum.empty else "fixed modes"
    proof = spectrum.evidence
    if isinstance(proof, TwoPolynomials):
        return f"{connected}, {fixed}: two polynomials of the whole"
    two = any(isinstance(block.evidence, CoprimePolynomials) for block in proof.blocks)
    return f"{connected}, {fixed}: " + ("two polynomials of a block" if two else "sequences")


def tried(small: PlainSystem, system: MultiChannelSystem) -> tuple[str, list[str]]:
    """Which proof is found for a system, and what is wrong with it."""
    problems = []
    found = fixed_spectrum(system)
    for spectrum in (found, without_sequences(system)):
        problems += fixed_factors(small, system, spectrum)
        verdict = check_document(encode(spectrum).encode())
        if verdict.verdict != "VALID":
            problems.append(verdict.line())
    fixed = sum((system.n - f.rank) * f.polynomial.degree for f in found.factors)
    for blocks in (bounded_blocks(system), getattr(found.evidence, "blocks", None)):
        if blocks is not None and modes_left(blocks) < fixed:
            problems.append(f"the blocks leave {modes_left(blocks)} modes, and {fixed} are fixed")
    if isinstance(found.evidence, ByBlocks) and modes_left(found.evidence.blocks) > fixed:
        problems.append("the blocks leave more than the factors")
    return evidence_of(system, found), problems


def main(count: int, path: Path) -> int:
    """Try the systems that are not in the file yet; print the counts of all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    done: dict[int, Any] = {}
    if path.exists():
        rows = map(json.loads, path.read_text(encoding="utf-8").splitlines())
        done = {row["seed"]: row for row in rows}
    with path.open("a", encoding="utf-8") as file:
        for seed in range(count):
            if seed not in done:
                proof, problems = tried(*drawn_pair(seed))
                done[seed] = {"seed": seed, "proof": proof, "problems": problems}
                print(json.dumps(done[seed]), file=file, flush=True)
    counts = Counter(done[seed]["proof"] for seed in range(count))
    wrong = [done[seed] for seed in range(count) if done[seed]["problems"]]
    print(f"{count} drawn systems, {len(wrong)} differ")
    for row in wrong:
        print(f"  {row['seed']}: {row['problems']}")
    for proof, number in counts.most_common():
        print(f"{number:7} {proof}")
    plants = [gallery.load(name) for name in gallery.names()]
    print(f"{len(plants)} plants of the gallery")
    for proof, number in Counter(evidence_of(p, fixed_spectrum(p)) for p in plants).most_common():
        print(f"{number:7} {proof}")
    return 1 if wrong else 0


if __name__ == "__main__":
    arguments = sys.argv[1:]
    chosen = Path(arguments[1]) if len(arguments) > 1 else FILE
    sys.exit(main(int(arguments[0]) if arguments else 10_000, chosen))
