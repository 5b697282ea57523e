"""The bytes of every exact certificate, for the plants of the gallery and for drawn ones.

Run as ``python -m tests.answer.test_golden`` to write ``golden.json`` anew, where a change of
bytes is intended.
"""

from __future__ import annotations

import hashlib
import json
import platform
import random
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any
from unittest import mock

import pytest
import scipy

import mcexact
from mcexact.analysis import blocks, controllability, fixed_modes, sharing, structure
from mcexact.analysis.questions import QUESTIONS
from mcexact.analysis.sharing import neighbor_graph
from mcexact.analysis.stability import open_loop_spectrum
from mcexact.answer.protocol import encode
from mcexact.derived.constructions import Share
from mcexact.derived.drawn.networks import NETWORKS, network_system
from mcexact.derived.drawn.primary_form import SeededChoices
from mcexact.errors import Impossible, LimitReached
from mcexact.exact.matrix import Matrix
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import canonical, plain
from tests.oracle.draws import exact, sparse_system
from tests.oracle.networks import held_verdict, lifted_verdict

GOLDEN = Path(__file__).with_name("golden.json")
DRAWN = 120
SHARING: tuple[Share, ...] = ("outputs+states", "states")
DESIGNED = ("liu2020-3ch-no-communication", "lexalutyi-two-double-integrators")

SOLVER = f"scipy {scipy.__version__}, {platform.machine()}"
"""What proposes branch trees."""

Answers = Iterator[tuple[str, Any]]


def plants() -> Iterator[tuple[str, MultiChannelSystem]]:
    """The gallery without feedthrough; then drawn ones in both times, half over drawn graphs."""
    for name in gallery.names():
        plant = gallery.load(name)
        if plant.D is None:
            yield name, plant
    for number in range(DRAWN):
        rng = random.Random(number)
        plant = exact(sparse_system(rng), ("continuous", "discrete")[number % 2])
        if number % 4 >= 2:
            plant = plant.with_neighbors(drawn_graph(rng, plant.names))
        yield f"drawn-{number}", plant


def drawn_graph(rng: random.Random, names: tuple[str, ...]) -> NeighborGraph:
    """A ring or a sparse graph, its messages delayed by 0, 1 or 2 units."""
    m = len(names)
    heard = [[(i + 1) % m] for i in range(m)]
    if rng.random() < 0.5:
        heard = [[j for j in range(m) if rng.random() < 0.3] for _ in range(m)]
    delays = [(i, j, rng.choice([0, 1, 2])) for i in range(m) for j in heard[i] if i != j]
    return NeighborGraph(names, heard, delays)


def answers(plant: MultiChannelSystem) -> Answers:
    """What can be asked about any system, with its graph if it has one, by the question."""
    yield from of_the_system(plant)
    yield from of_its_channels(plant)
    yield "minimal_communication", least(mcexact.minimal_communication, plant)
    if plant.neighbors is not None:
        yield from of_its_graph(plant)


def of_the_system(system: MultiChannelSystem) -> Answers:
    """Every question that `analyze` asks by default about any system, and other evidence."""
    for name, question in QUESTIONS.items():
        if question.by_default and not question.needs:
            yield name, question.decide(system)
    yield from of_large_systems(system)


def of_large_systems(system: MultiChannelSystem) -> Answers:
    """The evidence that large sparse systems have, for a small one."""
    with (
        mock.patch.object(controllability, "_SMALL", -1),
        mock.patch.object(sharing, "_SMALL", -1),
        mock.patch.object(structure, "is_large_and_sparse", lambda system: True),
        mock.patch.object(fixed_modes, "_in_parts", lambda system, blocks: True),
    ):
        found = {
            "controllability_by_blocks": mcexact.joint_controllability(system),
            "observability_by_blocks": mcexact.joint_observability(system),
            "deficiency_by_blocks": sharing.deficiency(system),
            "transfer_graph_by_paths": mcexact.transfer_graph(system),
            "fixed_spectrum_by_parts": mcexact.fixed_spectrum(system),
        }
        with mock.patch.object(blocks, "LARGEST_DENSE", 0):
            found["fixed_spectrum_by_products"] = mcexact.fixed_spectrum(system)
    yield from found.items()


def of_its_channels(system: MultiChannelSystem) -> Answers:
    """One channel, the set of it alone, and every channel at once."""
    name = system.names[-1]
    yield "channel_controllability", mcexact.joint_controllability(system, [name])
    yield "channel_observability", mcexact.joint_observability(system, [name])
    for want in ("controllable", "observable", "both"):
        yield (
            f"channel_gains_{want}",
            mcexact.questions.single_channel_gains(system, name, want=want),
        )
    yield "every_channel", mcexact.questions.single_channel_gains(system)
    spectrum = open_loop_spectrum(system)
    yield "spectrum_of_A", spectrum
    for factor, _ in spectrum.polynomial.factor():
        yield "pencil_rank", mcexact.questions.pencil_rank(system, [name], factor)
    if system.m > 1:
        yield "complementary_subsystem", mcexact.questions.complementary_subsystem(system, [name])
    yield "stability", mcexact.questions.certify_stability(system, method="polynomial")
    if system.n:
        ones = Matrix.from_integers([[1] * system.n for _ in range(system.n)])
        try:
            found = mcexact.questions.exceptional_gains(ones, system.A, system.input_matrix())
        except Impossible as refused:
            yield "exceptional_gains_refused", refused.certificate
            return
        yield "exceptional_gains_index_set", found.index_set
        yield "exceptional_gains_controllability_set", found.controllability_set


def of_regions() -> Iterator[tuple[str, Any]]:
    """A loop with the damping ratio 3/5 and the modulus 5, in regions that hold it or not."""
    A = [[-3, 4, 0], [-4, -3, 1], [0, 0, -2]]
    ports = [[[0], [0], [1]]], [[[1, 0, 0]]]
    loop = MultiChannelSystem(A, *ports)
    limits: dict[str, dict[str, Any]] = {
        "damped": {"damping": "1/2"},
        "not damped": {"damping": "3/5"},
        "slow": {"largest_modulus": "501/100"},
        "in a region": {"rate": 1, "damping": "1/2", "largest_modulus": 6},
        "not in a region": {"rate": 2, "damping": "1/2", "largest_modulus": 5},
    }
    for name, given in limits.items():
        yield name, mcexact.questions.certify_stability(loop, method="polynomial", **given)


def of_samples() -> Iterator[tuple[str, Any]]:
    """The eigenvalues and the transfer graphs of two plants at the samples."""
    cart = MultiChannelSystem([[0, 1], [0, "-1/3"]], [[[0], [1]], [[1], [0]]], [[[1, 0]], [[0, 1]]])
    for name, plant in (("cart", cart), ("tanks", gallery.load("quadruple-tank-pminus"))):
        for late in (0, 2):
            sampled = mcexact.constructions.sampled_system(plant, "1/7", late)
            yield f"{name}, {late} late", open_loop_spectrum(sampled)
            yield f"{name}, {late} late", mcexact.transfer_graph(sampled)


def of_parts() -> Iterator[tuple[str, Any]]:
    """Plants without what no output shows, or what no input moves."""
    for name in ("relative-positions-4", "swing-grid-four-buses"):
        left = mcexact.constructions.modulo(gallery.load(name))
        yield name, mcexact.fixed_spectrum(left)
        yield f"{name}, dual", mcexact.fixed_spectrum(mcexact.constructions.dual(left))


def of_feedthrough() -> Iterator[tuple[str, Any]]:
    """A plant whose inputs act on its outputs at once, and what is decided of it."""
    A, B, C = [[-1, -1], [-1, -1]], [[[-1], [-1]], [[1], [0]]], [[[1, 0]], [[1, 1]]]
    for sign in (1, -1):
        plant = MultiChannelSystem(A, B, C, D=[[0, 0], [sign, 0]])
        yield f"sign {sign}", mcexact.fixed_spectrum(plant)
        yield f"sign {sign}", mcexact.setpoint_solvability(plant)
        yield f"sign {sign}", mcexact.joint_observability(plant)


def of_failures() -> Iterator[tuple[str, Any]]:
    """Two plants after single failures, and with messages also after those of links."""
    for number, each in enumerate(mcexact.questions.failures(gallery.load("compleib-ac1")), 1):
        yield f"failure {number}", each
    plant = MultiChannelSystem(
        [[1]], [[[0]], [[1]]], [[[1]], [[0]]], neighbors={"1": ["2"], "2": ["1"]}
    )
    for number, each in enumerate(mcexact.questions.failures(plant, "outputs"), 1):
        yield f"failure {number} with messages", each


def of_periods() -> Iterator[tuple[str, Any]]:
    """The gallery's plant over a period of two steps, with static gains."""
    plant = gallery.load("movable-by-periodic-gains")
    gains = [
        mcexact.designs.local_controllers(plant, g) for g in ([[[0]], [["1/4"]]], [[[1]], [[0]]])
    ]
    controller = mcexact.designs.PeriodicController(tuple(gains))
    for radius in (None, "9/10", "1/2"):
        yield f"radius {radius}", mcexact.designs.certify_periodic(plant, controller, radius=radius)
    loop = mcexact.constructions.periodic_loop(plant, controller)
    yield "spectrum of a period", open_loop_spectrum(loop)


def of_a_parameter() -> Iterator[tuple[str, Any]]:
    """The paper's example with one of its entries free, and the valves of four tanks."""
    for i in range(3):
        for j in range(3):
            A: list[list[Any]] = [[1, 0, 0], [0, 1, 0], [0, 1, 1]]
            A[i][j] = "t"
            yield f"example: {i}, {j}", mcexact.fixed_spectrum(with_a_parameter(A, PORTS))
    yield "tanks", mcexact.fixed_spectrum(tanks("t", "7/10"))
    A = [[1, 0, 0], ["t", 1, 0], [0, "t - 1", 1]]
    plant = with_a_parameter(A, PORTS)
    yield "controllability", mcexact.joint_controllability(plant, ["1", "2"])
    yield "observability", mcexact.joint_observability(plant)
    ring = mcexact.NeighborGraph.ring(plant.names)
    extended = mcexact.constructions.extended_system(plant, (0, 0, 1), graph=ring)
    yield "shared dimensions", mcexact.fixed_spectrum(extended)
    yield "set-points", mcexact.setpoint_solvability(tanks("t", "7/10"))
    for k, ranks in enumerate(mcexact.observability_indices(plant, ["2"])):
        yield f"rank {k + 1}", ranks
    for pair, found in mcexact.transfer_graph(tanks("1/(t - 1)", "t^2")).columns.items():
        yield f"edge {pair}", found
    yield "tanks with a range", mcexact.fixed_spectrum(tanks("t", "t^2", (0, "1/2")))


PORTS = (
    ([[1], [0], [0]], [[1, 0, 0], [0, 0, 1]]),
    ([[0], [1], [0]], [[0, 1, 0]]),
    ([[1], [0], [0]], [[0, 1, 0]]),
)


def tanks(first: str, second: str, bounds: Any = (None, None)) -> mcexact.ParametricSystem:
    """Four tanks (Johansson 2000) with the ratios of two valves."""
    A = [
        ["-1/62", 0, "1/23", 0],
        [0, "-1/90", 0, "1/30"],
        [0, 0, "-1/23", 0],
        [0, 0, 0, "-1/30"],
    ]
    pumps = (
        [[f"333/2800*({first})"], [0], [0], [f"333/3200*(1 - {first})"]],
        [[0], [f"335/3200*({second})"], [f"335/2800*(1 - {second})"], [0]],
    )
    levels = ([["1/2", 0, 0, 0]], [[0, "1/2", 0, 0]])
    return with_a_parameter(A, tuple(zip(pumps, levels, strict=True)), bounds)


def with_a_parameter(A: Any, ports: Any, bounds: Any = (None, None)) -> mcexact.ParametricSystem:
    """A plant with the parameter t."""
    B, C = zip(*ports, strict=True)
    return mcexact.ParametricSystem(A, B, C, parameters=["t"], assume={"t": bounds})


def of_its_graph(plant: MultiChannelSystem) -> Answers:
    """What agents can share, at once and with the delays of their messages."""
    yield "neighbor_graph", neighbor_graph(plant)
    yield "sharing_gap", mcexact.sharing.sharing_gap(plant)
    for information in ("own", "outputs"):
        found = mcexact.questions.structural_fixed_modes(plant, information)
        yield f"structural_fixed_modes_{information}", found
    zero = [[[0] * plant.n for _ in range(plant.p(i))] for i in range(plant.m)]
    yield "error_gains", mcexact.questions.error_gains(plant, zero).answer
    for name, found in of_the_system(mcexact.constructions.augmented_outputs(plant)):
        yield f"augmented_{name}", found
    for share in SHARING:
        bound = mcexact.sharing.shared_dimension_bound(plant, share=share)
        yield f"shared_dimension_bound_{share}", bound
        yield f"common_dimension_{share}", mcexact.sharing.common_dimension(plant, share=share)
        for free in (False, True):
            found = least(
                mcexact.sharing.minimal_shared_dimensions,
                plant,
                share=share,
                free_assignability=free,
            )
            yield f"minimal_shared_dimensions_{share}", found
        extended = mcexact.constructions.extended_system(plant, [1] * plant.m, share)
        yield f"extended_fixed_spectrum_{share}", mcexact.fixed_spectrum(extended)
        yield (
            f"links_{share}",
            least(mcexact.minimal_communication, plant, share=share, dimensions=[1] * plant.m),
        )
    if plant.time == "discrete":
        for name, verdict in (
            ("lifted", lifted_verdict(plant, [bound.deficiency] * plant.m)),
            ("held", held_verdict(plant, [bound.deficiency] * plant.m)),
        ):
            yield f"{name}_fixed_spectrum", verdict.spectrum
            yield f"{name}_joint_controllability", verdict.controllability
            yield f"{name}_joint_observability", verdict.observability


def networks() -> Iterator[tuple[str, MultiChannelSystem]]:
    """Plants whose matrices list their entries."""
    for name in NETWORKS:
        yield f"network: {name}", network_system(SeededChoices(1), name, 120, 6)


def of_a_network(system: MultiChannelSystem) -> Answers:
    yield "network_fixed_spectrum", mcexact.fixed_spectrum(system)
    yield "network_joint_controllability", mcexact.joint_controllability(system)
    yield "network_joint_observability", mcexact.joint_observability(system)
    yield "network_transfer_graph", mcexact.transfer_graph(system)


def least(solve: Any, plant: MultiChannelSystem, **arguments: Any) -> Any:
    """The answer of a program, or None at its limit."""
    try:
        return solve(plant, **arguments)
    except LimitReached:
        return None


def designs() -> Iterator[tuple[str, Answers]]:
    """Certificates of exact designs for a rate, about the loop and what it was made of."""
    for name in DESIGNED:
        plant = gallery.load(name)
        plant = plant.with_neighbors(NeighborGraph.ring(plant.names))
        for design in ("observer", "decentralized", "extended", "setpoint"):
            # The gains of a search depend on the processor.
            alone = {} if design == "observer" else {"aims": mcexact.designs.Aims(effort=0)}
            try:
                made = getattr(mcexact, f"design_{design}")(plant, rate=1, **alone)
            except Impossible as refused:
                yield f"{design}: {name}", iter([("refusal", refused.certificate)])
            else:
                yield f"{design}: {name}", iter(sorted(made.certificates.items()))


def digests(asked: Iterable[tuple[str, MultiChannelSystem]]) -> dict[str, dict[str, str]]:
    """One digest for each plant, for each question, for each design, and for all branch trees.

    Those of questions and of trees are about all plants together.  A tree is proposed by scipy's
    solver, and another version of it may propose another one.
    """
    found: dict[str, dict[str, Any]] = {"plants": {}, "questions": {}, "designs": {}, "trees": {}}

    def add(text: str, *places: tuple[str, str]) -> None:
        for place, key in places:
            found[place].setdefault(key, hashlib.sha256()).update(text.encode("ascii"))

    def add_answer(answer: Any, *places: tuple[str, str]) -> None:
        if hasattr(answer, "tree"):
            add(encode(answer), ("trees", SOLVER))
            add(canonical(plain([answer.system, answer.subject, answer.claim()])), *places)
        elif answer is not None:
            add(encode(answer), *places)

    for name, plant in asked:
        for question, answer in answers(plant):
            add_answer(answer, ("plants", name), ("questions", question))
    for name, plant in networks():
        for question, answer in of_a_network(plant):
            add_answer(answer, ("plants", name), ("questions", question))
    for name, answer in of_a_parameter():
        add_answer(answer, ("plants", f"with a parameter: {name}"), ("questions", answer.kind))
    for name, answer in of_samples():
        add_answer(answer, ("plants", f"at the samples: {name}"), ("questions", "at the samples"))
    for name, answer in of_parts():
        add_answer(answer, ("plants", f"modulo: {name}"), ("questions", "modulo a part"))
    for name, answer in of_failures():
        add_answer(answer, ("plants", f"after a failure: {name}"), ("questions", "after a failure"))
    for name, answer in of_periods():
        add_answer(answer, ("plants", f"over a period: {name}"), ("questions", "over a period"))
    for name, answer in of_feedthrough():
        add_answer(answer, ("plants", f"feedthrough: {name}"), ("questions", "feedthrough"))
    for name, answer in of_regions():
        add_answer(answer, ("plants", f"a loop: {name}"), ("questions", "stability in a region"))
    for name, made in designs():
        for _, answer in made:
            add_answer(answer, ("designs", name))
    return {
        place: {key: each.hexdigest() for key, each in sorted(table.items())}
        for place, table in found.items()
    }


def test_exact_certificates_of_small_plants_have_the_recorded_bytes() -> None:
    small = [each for each in plants() if each[1].n <= 8]
    published, drawn = small[:-DRAWN], small[-DRAWN:]
    recorded, found = json.loads(GOLDEN.read_text()), digests(published + drawn[::9])
    same = {key for key, _ in set(recorded["plants"].items()) & set(found["plants"].items())}
    assert found["plants"].keys() == same
    assert recorded["designs"] == found["designs"]
    assert recorded["questions"].keys() == found["questions"].keys()


@pytest.mark.slow
def test_every_exact_certificate_has_the_recorded_bytes() -> None:
    recorded, found = json.loads(GOLDEN.read_text()), digests(plants())
    if found["trees"].keys() != recorded["trees"].keys():
        del recorded["trees"]
    changed = {
        place: sorted({key for key, _ in set(recorded[place].items()) ^ set(found[place].items())})
        for place in recorded
    }
    assert not any(changed.values()), changed


if __name__ == "__main__":
    GOLDEN.write_text(json.dumps(digests(plants()), indent=1) + "\n", encoding="ascii")
