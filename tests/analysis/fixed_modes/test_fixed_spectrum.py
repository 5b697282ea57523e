"""Fixed spectra: known answers, laws, the checker, and the oracle that enumerates all subsets."""

import dataclasses
import random
from collections import Counter
from fractions import Fraction
from pathlib import Path

import pytest

from mcexact.analysis import blocks as blocks_module
from mcexact.analysis import fixed_modes as module
from mcexact.analysis.analyze import Analysis, analyze
from mcexact.analysis.blocks import bounded_blocks, modes_left
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.subspaces import CommonFactor, decide
from mcexact.answer import protocol
from mcexact.answer.evidence import Block, CoprimePolynomials, LocalSubspace
from mcexact.answer.modes import ByBlocks, FixedFactor, FixedSpectrum
from mcexact.checker.command import manifest_verdicts
from mcexact.checker.core.reading import Limits
from mcexact.checker.kinds import Expectation, check_document
from mcexact.derived.constructions import dual
from mcexact.derived.drawn.primary_form import SeededChoices
from mcexact.derived.drawn.systems import system_with_fixed_mode
from mcexact.errors import LimitReached
from mcexact.exact.linear_algebra import characteristic_polynomial, inverse
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import polynomial_residues
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model import gallery
from mcexact.model.system import MultiChannelSystem
from tests.oracle.agreement import disagreements, drawn_pair
from tests.oracle.draws import exact, sparse_system
from tests.oracle.planted import planted
from tests.wording import refusal, says

Factors = dict[Polynomial, tuple[int, int, int, frozenset[str]]]


def factors(spectrum: FixedSpectrum) -> Factors:
    """Everything that is said about the factors, apart from where their roots lie."""
    return {
        f.polynomial: (
            f.multiplicity_in_A,
            f.multiplicity_at_most,
            f.rank,
            frozenset(f.channels),
        )
        for f in spectrum.factors
    }


def checked(system: MultiChannelSystem) -> FixedSpectrum:
    """The fixed spectrum, its certificate accepted."""
    spectrum = fixed_spectrum(system)
    verdict = check_document(protocol.encode(spectrum).encode())
    assert verdict.verdict == "VALID", verdict
    return spectrum


@pytest.mark.parametrize("start", range(0, 250, 25))
def test_drawn_systems_agree_with_the_enumeration_of_all_subsets(start: int) -> None:
    """All decisions of the spine and their certificates."""
    with_fixed_modes = 0
    for seed in range(10**6 + start, 10**6 + start + 25):
        problems, fixed = disagreements(*drawn_pair(seed))
        assert not problems, (seed, problems)
        with_fixed_modes += fixed
    assert with_fixed_modes > 5


@pytest.mark.parametrize("name", gallery.names())
def test_published_systems_have_the_published_fixed_modes(name: str) -> None:
    import sympy

    def written(polynomial: Polynomial) -> sympy.Poly:
        return sympy.Poly([*reversed(polynomial.coefficients)], sympy.Symbol("x"), domain="QQ")

    spectrum = checked(gallery.load(name))
    x = sympy.Symbol("x")
    wanted = {
        (
            sympy.Poly(sympy.sympify(e["factor"].replace("^", "**"), rational=True), x),
            e["multiplicity"],
        )
        for e in gallery.expected(name)["fixed_factors"]
    }
    found = {(written(f.polynomial), f.multiplicity_at_most) for f in spectrum.factors}
    assert {(p.set_domain("QQ"), e) for p, e in wanted} == found


def test_the_example_of_the_paper_keeps_1_because_of_channels_2_and_3() -> None:
    spectrum = checked(gallery.load("liu2020-3ch-no-communication"))
    [factor] = spectrum.factors
    assert str(factor.polynomial) == "x - 1"
    assert (factor.channels, factor.rank, factor.stable) == (("2", "3"), 2, False)
    assert not spectrum.stabilizable
    assert spectrum.best_rate is not None
    assert (spectrum.best_rate.lower, spectrum.best_rate.upper) == ("-1", "-1")


def test_the_hidden_triple_mode_is_found_three_times_over() -> None:
    [factor] = checked(gallery.load("hidden-triple-mode")).factors
    assert str(factor.polynomial) == "x - 1"
    assert (factor.multiplicity_in_A, factor.multiplicity_at_most) == (3, 3)


def edge_systems() -> dict[str, tuple[MultiChannelSystem, list[str]]]:
    """Systems at the edges, with the fixed factors they have."""
    huge = 10**40 + 7
    unit = [[1, 0], [0, 1]]
    nothing = Matrix.zeros(2, 0)
    return {
        "no states": (MultiChannelSystem([], [Matrix.zeros(0, 1)], [Matrix.zeros(1, 0)]), []),
        "no inputs": (MultiChannelSystem([[0, 1], [2, 0]], [nothing], [unit]), ["x^2 - 2"]),
        "no outputs": (
            MultiChannelSystem([[0, 1], [2, 0]], [unit], [Matrix.zeros(0, 2)]),
            ["x^2 - 2"],
        ),
        "B = 0": (MultiChannelSystem(unit, [[[0], [0]]], [unit]), ["x - 1"]),
        "C = 0": (MultiChannelSystem([[2, 0], [0, 3]], [unit], [[[0, 0]]]), ["x - 3", "x - 2"]),
        "A = 0, one channel": (MultiChannelSystem([[0, 0], [0, 0]], [unit], [unit]), []),
        "equal eigenvalues, one input": (
            MultiChannelSystem(unit, [[[1], [1]]], [unit]),
            ["x - 1"],
        ),
        "one inactive channel": (
            MultiChannelSystem([[5]], [[[0]], [[1]]], [[[1]], [[1]]]),
            [],
        ),
        "all channels inactive in one way": (
            MultiChannelSystem([[5]], [[[0]], [[1]]], [[[1]], [[0]]]),
            ["x - 5"],
        ),
        "denominators beyond 64 bits": (
            MultiChannelSystem(
                [[Fraction(1, huge), 0], [0, Fraction(2, huge + 2)]],
                [[[Fraction(3, huge)], [0]]],
                [unit],
            ),
            [f"x - {Fraction(2, huge + 2)}"],
        ),
        "irrational modes of degree 3": (
            MultiChannelSystem([[0, 0, 2], [1, 0, 0], [0, 1, 0]], [[[0], [0], [0]]], [[[1, 0, 0]]]),
            ["x^3 - 2"],
        ),
    }


@pytest.mark.parametrize("name", edge_systems())
def test_edge_systems_have_the_fixed_factors_they_must(name: str) -> None:
    system, wanted = edge_systems()[name]
    spectrum = checked(system)
    assert [str(f.polynomial) for f in spectrum.factors] == wanted
    assert spectrum.empty == (not wanted)


def test_discrete_time_places_modes_by_their_modulus() -> None:
    B, C = [[[0], [0]]], [[[1, 1]]]
    A = [["1/2", 0], [0, "-3/4"]]
    inside = checked(MultiChannelSystem(A, B, C, time="discrete"))
    assert inside.stabilizable
    assert inside.best_rate is not None
    assert inside.best_rate.lower == inside.best_rate.upper == "0.75"
    outside = inside.outside(StabilityRegion("discrete", Fraction(5, 8)))
    assert [str(f.polynomial) for f in outside] == ["x + 3/4"]
    continuous = checked(MultiChannelSystem(A, B, C))
    assert not continuous.stabilizable
    assert {str(f.polynomial): f.stable for f in continuous.factors} == {
        "x - 1/2": False,
        "x + 3/4": True,
    }


def test_the_same_system_gives_the_same_certificate() -> None:
    first, second = (fixed_spectrum(gallery.load("compleib-roc5")) for _ in range(2))
    assert protocol.encode(first) == protocol.encode(second)


def small_systems(count: int) -> list[MultiChannelSystem]:
    rng = random.Random(20)
    return [exact(sparse_system(rng)) for _ in range(count)]


def test_similar_systems_have_the_same_fixed_factors() -> None:
    rng = random.Random(1)
    for system in small_systems(25):
        n = system.n
        while True:
            S = Matrix.from_integers(
                [[rng.randint(-2, 2) for _ in range(n)] for _ in range(n)], ncols=n
            )
            R = inverse(S)
            if R is not None:
                break
        similar = MultiChannelSystem(
            S @ system.A @ R, [S @ c.B for c in system.channels], [c.C @ R for c in system.channels]
        )
        assert factors(fixed_spectrum(similar)) == factors(fixed_spectrum(system))


def test_permuting_the_channels_permutes_the_obstruction() -> None:
    rng = random.Random(2)
    for system in small_systems(25):
        order = rng.sample(range(system.m), system.m)
        permuted = MultiChannelSystem(
            system.A,
            [system.B(i) for i in order],
            [system.C(i) for i in order],
            names=[system.names[i] for i in order],
        )
        assert factors(fixed_spectrum(permuted)) == factors(fixed_spectrum(system))


def test_the_dual_has_the_same_fixed_factors_and_ranks() -> None:
    for system in small_systems(25):
        ours, theirs = factors(fixed_spectrum(system)), factors(fixed_spectrum(dual(system)))
        assert {p: f[:3] for p, f in ours.items()} == {p: f[:3] for p, f in theirs.items()}


def test_adding_a_channel_never_creates_fixed_modes() -> None:
    rng = random.Random(3)
    for system in small_systems(25):
        n = system.n
        extra = Matrix.from_integers([[rng.randint(-1, 1)] for _ in range(n)], ncols=1)
        wider = MultiChannelSystem(
            system.A,
            [c.B for c in system.channels] + [extra],
            [c.C for c in system.channels] + [extra.T],
        )
        before, after = factors(fixed_spectrum(system)), factors(fixed_spectrum(wider))
        assert after.keys() <= before.keys()
        assert all(after[p][2] >= before[p][2] for p in after)


@pytest.mark.parametrize("degree", [1, 3])
def test_a_planted_mode_is_found_among_80_states_and_40_channels(degree: int) -> None:
    drawn = system_with_fixed_mode(SeededChoices(degree), states=80, channels=40, degree=degree)
    spectrum = fixed_spectrum(drawn.system)
    verdict = check_document(protocol.encode(spectrum).encode())
    assert verdict.verdict == "VALID", verdict
    assert drawn.fixed_mode in [f.polynomial for f in spectrum.factors]


def test_many_decoupled_integrators_need_no_luck() -> None:
    """A platoon: small gains would almost never do."""
    n = 40
    I = Matrix.identity(n)
    system = MultiChannelSystem(
        Matrix.zeros(n, n),
        [I.take(cols=[i]) for i in range(n)],
        [I.take(rows=[i]) for i in range(n)],
    )
    assert checked(system).empty


def test_common_factors_are_lifted_from_several_primes_when_one_is_too_short() -> None:
    root = Fraction(10**30 + 57, 3**20)
    factor = Polynomial.of(-root, 1)
    chi = factor * Polynomial.of(1, 1)
    lift = CommonFactor(chi, 3**20)
    found = None
    for prime in (2**61 - 1, 2**31 - 1, 2**19 - 1):
        assert found is None
        found = lift.lifted(polynomial_residues(factor, prime))
    assert found == factor


def test_a_common_factor_by_accident_is_forgotten() -> None:
    chi = Polynomial.from_roots([1, 2, 3])
    lift = CommonFactor(chi, 1)
    accident = Polynomial.of(-1, 1) * Polynomial.of(-5, 1)
    assert lift.lifted(polynomial_residues(accident, 101)) is None
    assert lift.lifted(polynomial_residues(Polynomial.of(-1, 1), 103)) == Polynomial.of(-1, 1)
    assert lift.lifted(polynomial_residues(accident, 107)) is None


def test_the_rest_of_the_spectrum_is_moved_by_the_gains_of_the_decision() -> None:
    system = gallery.load("compleib-roc5")
    decision = decide(system, random.Random(0))
    [found] = decision.obstructions
    rest = characteristic_polynomial(system.A) // found.polynomial**found.multiplicity_in_A
    common = polynomial_residues(rest, decision.modular.modulus).gcd(decision.closed)
    assert common.degree == 0


def without_multiplicity(spectrum: FixedSpectrum) -> list[FixedFactor]:
    return [
        dataclasses.replace(f, multiplicity_in_A=None, multiplicity_at_most=0, channels=())
        for f in spectrum.factors
    ]


@pytest.mark.parametrize("largest_dense", [0, 500])
def test_the_search_block_by_block_finds_the_same(
    largest_dense: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The channels named are among those of the largest set with the least rank."""
    monkeypatch.setattr(module, "_in_parts", lambda system, blocks: True)
    monkeypatch.setattr(blocks_module, "LARGEST_DENSE", largest_dense)
    counted: Counter[str] = Counter()
    for number in range(150):
        system = exact(sparse_system(random.Random(number)))
        found = fixed_spectrum(system)
        with monkeypatch.context() as patched:
            patched.setattr(module, "_in_parts", lambda system, blocks: False)
            expected = fixed_spectrum(system)
        assert without_multiplicity(found) == without_multiplicity(expected)
        assert found.best_rate == expected.best_rate
        for f, largest in zip(found.factors, expected.factors, strict=True):
            assert set(f.channels) <= set(largest.channels)
        assert check_document(protocol.encode(found).encode()).verdict == "VALID"
        if not found.empty:
            open_ = any(f.multiplicity_in_A is None for f in found.factors)
            assert isinstance(found.evidence, ByBlocks) or not open_
            counted["open" if open_ else "in A"] += 1
            counted["local"] += any(isinstance(s, LocalSubspace) for s in found.evidence.subspaces)
    assert counted["open"] > 3 * counted["in A"], counted
    assert counted["local"] > 10, counted


def test_a_mode_planted_in_a_large_sparse_system_is_certified() -> None:
    """One channel of 60 sees it, none moves it; how often it is in A stays open."""
    found = fixed_spectrum(planted(600, 60, 1))
    [factor] = found.factors
    assert (str(factor.polynomial), factor.multiplicity_in_A) == ("x + 3", None)
    assert (len(factor.channels), factor.rank) == (59, 599)
    assert check_document(protocol.encode(found).encode()).verdict == "VALID"


def chain_of_pairs(count: int, size: int) -> MultiChannelSystem:
    """Blocks of two states, each with a channel, of which one needs two polynomials."""
    A = [(2 * k, 2 * k + 1, 1) for k in range(count)]
    A += [(2 * k, 2 * k - 1, 1) for k in range(1, count)]
    here = [2 * k + 1 for k in range(count)], [2 * k for k in range(count)]
    B = [Matrix.from_entries((size, 1), [(i, 0, 1)]) for i in here[0]]
    C = [Matrix.from_entries((1, size), [(0, j, 1)]) for j in here[1]]
    return MultiChannelSystem(Matrix.from_entries((size, size), A), B, C)


def test_small_blocks_without_a_sequence_are_completed_one_by_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    system = chain_of_pairs(60, 120)
    blocks = bounded_blocks(system)
    assert len(blocks) == 60
    assert not modes_left(blocks)
    short = (*blocks[:5], Block(blocks[5].states, None), *blocks[6:])
    monkeypatch.setattr(module, "_in_parts", lambda system, blocks: True)
    monkeypatch.setattr(module, "bounded_blocks", lambda system: short)
    monkeypatch.setattr(module, "decide", None)  # the whole is not decided
    found = fixed_spectrum(system)
    assert found.empty
    assert isinstance(found.evidence, ByBlocks)
    assert isinstance(found.evidence.blocks[5].evidence, CoprimePolynomials)
    assert check_document(protocol.encode(found).encode()).verdict == "VALID"


def test_many_fixed_modes_are_not_looked_for_sparsely(monkeypatch: pytest.MonkeyPatch) -> None:
    n = 6000
    nothing = MultiChannelSystem(
        Matrix.zeros(n, n), [Matrix.zeros(n, 1)], [Matrix.zeros(1, n)], time="discrete"
    )
    monkeypatch.setattr(blocks_module, "fixed_subspaces", None)
    found = analyze(nothing)
    with refusal(LimitReached):
        found.fixed_spectrum  # noqa: B018
    with refusal(LimitReached):
        found.completeness  # noqa: B018
    assert {"fixed_spectrum", "completeness"} <= set(found.open())


def told(found: Analysis, place: str) -> str:
    return "\n".join(map(str, found.sentences.at(place)))


@pytest.mark.parametrize("rows", [[[1]], [[0, -1], [1, 0]]])
def test_what_is_told_where_it_is_open_how_often_a_mode_is_in_A(
    rows: list[list[int]], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(module, "_in_parts", lambda system, blocks: True)
    n = len(rows)
    A = [[*row, 0] for row in rows] + [[0] * n + [5]]
    found = analyze(MultiChannelSystem(A, [[[0]] * n + [[1]]], [[[0] * n + [1]]]))
    assert says(told(found, "answer.mode"), "least once")
    assert "| open |" in told(found, "fixed-modes")
    assert " & open & " in told(found, "latex")
    assert (" can be moved" in told(found, "table")) is (n == 1)
    found.save(tmp_path)
    assert {
        each.verdict for _, each in manifest_verdicts(str(tmp_path), Expectation(), Limits())
    } == {"VALID", "IMPLIED", "REMARK"}
