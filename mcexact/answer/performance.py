"""The performance of loops: answers about cost, margins, sectors and steps.

Each answer is proved by a few symmetric matrices, one for each inequality (`Symmetric`), which are
proposed in floating point, rounded to few bits, and verified exactly.

- `LoopCost`: an upper bound on the stationary mean of x'Qx + u'Ru of one loop.
- `CostBound`: a lower bound on it for every linear time-invariant controller, or for those whose
  agents act on each other along the edges of a graph alone (`CostGraph`).
- `DiskMargin`: the loop is stable while its inputs or outputs are multiplied by complex numbers
  near 1.
- `SectorStability`: it is stable while its inputs pass through nonlinearities within sectors.
- `StepPeaks`: how large its inputs and outputs become after a step, which a response in integers
  proves beside the matrix.

The sentences name the weights, and say for which controllers a bound holds.  The first line of
`design` and `certify` consists of short ones: the cost of the loop beside a bound of the same
weights, the least disk margin of a single input or output, and the plants with stable loops.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, Literal

from mcexact.answer.analysis import Said
from mcexact.answer.protocol import LEFT_OUT, Answer, Part, answer, claim, witness
from mcexact.answer.sentence import Certified, Claim, Context, Rulebook
from mcexact.answer.templates import Template
from mcexact.derived.sampling import is_sampled
from mcexact.exact.matrix import Matrix
from mcexact.exact.roots import is_discrete


@dataclass(frozen=True)
class Symmetric(Part):
    """A symmetric matrix of few bits, with the entries s_ij 2^(e_i + e_j).

    Attributes
    ----------
    exponents : tuple of int
        e_1, …, e_n.
    entries : tuple of int
        The s_ij with j ≤ i, row by row.
    """

    exponents: tuple[int, ...]
    entries: tuple[int, ...]

    def matrix(self) -> Matrix:
        """Return the matrix, n × n."""
        n, least = len(self.exponents), min(self.exponents, default=0)
        e, rows = [each - least for each in self.exponents], [[0] * n for _ in range(n)]
        entries = iter(self.entries)
        for i in range(n):
            for j in range(i + 1):
                rows[i][j] = rows[j][i] = next(entries) << (e[i] + e[j])
        return Matrix.from_integers(rows, 1, n) * Fraction(2) ** (2 * least)


@dataclass(frozen=True)
class CostWeights(Part):
    """The weights of the stationary mean of x'Qx + u'Ru; Q, R, W and V are diagonal.

    Attributes
    ----------
    states : tuple of Fraction
        The diagonal of Q, from 0 on, one for each state.
    inputs : tuple of Fraction
        The diagonal of R, above 0, one for each input, in the order of the channels.
    disturbances : tuple of Fraction
        The intensities W of the white disturbances of the states, from 0 on.
    noise : tuple of Fraction
        The intensities V of the white noise of the outputs, from 0 on.
    bandwidth : Fraction or None
        In continuous time ω > 0: the noise v passes a filter, v' = −ωv + ωn with n white.  None
        means that v is white, which is for controllers alone that pass no output on at once.
    """

    states: tuple[Fraction, ...]
    inputs: tuple[Fraction, ...]
    disturbances: tuple[Fraction, ...]
    noise: tuple[Fraction, ...]
    bandwidth: Fraction | None = field(default=None, kw_only=True, metadata=LEFT_OUT)


@answer("loop_cost")
class LoopCost(Answer):
    """The loop is stable, and its stationary mean of x'Qx + u'Ru is at most ``cost``.

    Attributes
    ----------
    weights : CostWeights
        For the states of the plant, or of the system that the loop was closed around.
    cost : Fraction
    P : Symmetric
        Of the loop, in continuous time with the filters of the noise behind it.
    """

    weights: CostWeights = claim()
    cost: Fraction = claim()
    P: Symmetric = witness()


@dataclass(frozen=True)
class CostGraph(Part):
    """Who acts on whom: from j to i if something of agent j enters something of agent i.

    Attributes
    ----------
    states : tuple of str
        For each state of the plant the agent to whom it belongs.
    edges : tuple of tuple of str
        The pairs (j, i), j ≠ i, in the order of the channels.
    """

    states: tuple[str, ...]
    edges: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class CostGroup(Part):
    """The proof of a bound for the disturbances and the noise of a group of agents.

    Attributes
    ----------
    agents : tuple of str
        Nobody outside of the group receives anything from it.
    disturbances, noise : tuple of Fraction
        What the group takes of the intensities, for its states and outputs.
    P, S : Symmetric
        For the states of the group.
    F : Matrix
        Its inputs × its states.
    share : Fraction
        s, from 0 on and below 1.
    """

    agents: tuple[str, ...]
    disturbances: tuple[Fraction, ...]
    noise: tuple[Fraction, ...]
    P: Symmetric
    S: Symmetric
    F: Matrix
    share: Fraction


@answer("cost_bound")
class CostBound(Answer):
    """No linear time-invariant controller has a smaller stationary mean of x'Qx + u'Ru.

    Attributes
    ----------
    weights : CostWeights
    cost : Fraction
    graph : CostGraph or None
        If it is not None, only controllers are meant by which agents act on each other along the
        edges alone.
    groups : tuple of CostGroup
    """

    weights: CostWeights = claim()
    cost: Fraction = claim()
    graph: CostGraph | None = claim(optional=True)
    groups: tuple[CostGroup, ...] = witness()


@dataclass(frozen=True)
class MarginPart(Part):
    """The proof of a disk margin of some inputs, or of some outputs, all of them at once.

    Attributes
    ----------
    ports : tuple of int
        Their places, from 0, in the order of the channels.
    scaling : tuple of Fraction
        A number above 0 for each.
    P : Symmetric
    """

    ports: tuple[int, ...]
    scaling: tuple[Fraction, ...]
    P: Symmetric


@answer("disk_margin")
class DiskMargin(Answer):
    """The loop is stable while ports are multiplied by (1 + d/2)/(1 − d/2), abs(d) ≤ ``margin``.

    Attributes
    ----------
    at : {"inputs", "outputs"}
    together : bool
        Whether all of them are multiplied, with a complex number d for each; else any one of them.
    margin : Fraction
    parts : tuple of MarginPart
        Each proves the margin for its ports at once, and so for each of them.
    """

    at: Literal["inputs", "outputs"] = claim()
    together: bool = claim()
    margin: Fraction = claim()
    parts: tuple[MarginPart, ...] = witness()


@answer("sector")
class SectorStability(Answer):
    """The loop is stable where each input passes through a nonlinearity within its sector.

    Attributes
    ----------
    sectors : tuple of tuple of Fraction
        The ends (a, b) for each input: f(t, v) lies between av and bv.
    scaling : tuple of Fraction
        A number above 0 for each input.
    P : Symmetric
    """

    sectors: tuple[tuple[Fraction, Fraction], ...] = claim()
    scaling: tuple[Fraction, ...] = witness()
    P: Symmetric = witness()


@dataclass(frozen=True)
class StepResponse(Part):
    """How the response to a step is computed in integers, with a bound of all that is neglected.

    Attributes
    ----------
    P : Symmetric
        In its norm abs(v)² = v'Pv every error of a response falls.
    rate : Fraction
        a > 0: it falls as exp(−at) or faster, in discrete time as (1 − 2a)^(t/2).
    sizes : tuple of Fraction
        Of each input, then of each output: how large it is at most for states of the norm 1.
    bits, unit : int
        Integers have so many bits, and one of them has the norm 2^unit.
    times : int
        The number of steps of time, after which nothing larger follows.
    step : Fraction or None
        In continuous time the length of these steps.
    """

    P: Symmetric
    rate: Fraction
    sizes: tuple[Fraction, ...]
    bits: int
    unit: int
    times: int
    step: Fraction | None = field(default=None, kw_only=True, metadata=LEFT_OUT)


@answer("step_peaks")
class StepPeaks(Answer):
    """How large inputs and outputs become after a step, for a loop that was at rest.

    A constant 1 is added to one of the inputs, or to one of the outputs as agents receive them, or
    one of the set-points changes from 0 to 1.  Each row is about one such step, in the order of the
    channels, and bounds the absolute values of all inputs that agents compute, or of all outputs.

    Attributes
    ----------
    at : {"inputs", "outputs", "setpoints"}
    inputs : tuple of tuple of Fraction
    outputs : tuple of tuple of Fraction
    response : StepResponse
    """

    at: Literal["inputs", "outputs", "setpoints"] = claim()
    inputs: tuple[tuple[Fraction, ...], ...] = claim()
    outputs: tuple[tuple[Fraction, ...], ...] = claim()
    response: StepResponse = witness(whole=True)


# Templates.

COST = Template("performance-cost", "at most {cost:digits_above}, {weights:weights}", label="cost")
BOUND = Template(
    "performance-bound",
    "at least {cost:digits_below} for every linear time-invariant controller{proper:proper}, "
    "{weights:weights}",
    label="cost of others",
)
GROUP_BOUND = Template(
    "performance-bound-graph",
    "at least {cost:digits_below} for every linear time-invariant controller{proper:proper} by "
    "which agents act on each other along {edges:edges} alone, {weights:weights}",
    label="cost of others in the same graph",
)
_TIMES = "at most {ratio:digits_above} times that of every linear time-invariant controller"
RATIO = Template("performance-ratio", _TIMES + "{proper:proper}", label="cost beside others")
GROUP_RATIO = Template(
    "performance-ratio-graph",
    _TIMES + "{proper:proper} by which agents act on each other along {edges:edges} alone",
    label="cost beside others in the same graph",
)
_MARGIN = "at least {margin:digits_below}"
MARGINS = {
    "input_margin": Template(
        "performance-input-margin", _MARGIN, label="disk margin of each input by itself"
    ),
    "output_margin": Template(
        "performance-output-margin", _MARGIN, label="disk margin of each output by itself"
    ),
    "all_inputs_margin": Template(
        "performance-all-inputs-margin", _MARGIN, label="disk margin of all inputs together"
    ),
    "all_outputs_margin": Template(
        "performance-all-outputs-margin", _MARGIN, label="disk margin of all outputs together"
    ),
}
ANOTHER_STEP = Template(
    "performance-another-step",
    "at least {margin:digits_below} at every single input and output, with the same numbers every "
    "{step:step}",
    label="disk margin with a longer step",
)
HELD = Template(
    "performance-at-samples",
    "at least {margin:digits_below} at every single input and output, where the controller acts "
    "every {step:step} units of time, made by Tustin's rule, and inputs are set at once; its "
    "numbers are rounded to 12 digits, those of the plant at samples to 12 decimals",
    label="disk margin at samples",
)
SECTORS = Template(
    "performance-sectors",
    "tends to rest if each input of the plant is any function of the time and of the value that "
    "its agent computes, between the multiples {sectors:sectors} of this value",
    label="loop with nonlinear inputs",
)
_TIMES_THE_STEP = "at most {peak:digits_above} times the step"
STEPS = {
    "input_steps": Template(
        "performance-input-steps", _TIMES_THE_STEP, label="peak of an input after a step there"
    ),
    "output_steps": Template(
        "performance-output-steps", _TIMES_THE_STEP, label="peak of an output after a step there"
    ),
    "setpoint_steps": Template(
        "performance-setpoint-steps",
        _TIMES_THE_STEP,
        label="peak of an output after a step of its set-point",
    ),
}
FIRST_COST = Template(
    "first-cost", "cost ≤ {ratio:digits_above} × any LTI controller's{proper:proper}"
)
FIRST_MARGIN = Template(
    "first-margin", "disk margin ≥ {margin:digits_below} at each input and output"
)
FIRST_BOX = Template("first-box", "stable within {part:percent} of each entry")
FIRST_SAMPLED = Template("first-sampled", "sampled every {step:step}{late:short late}")
FIRST_EXACT = Template("first-exact", "stable for its exact samples")
FIRST_RADII = Template("first-radii", "stable for all plants within the radii")

# Rules.

RULES = Rulebook()


def _weighed(weights: Claim) -> tuple[Any, ...]:
    """The diagonals of Q, R, W and V, and the bandwidth, as a form writes them."""
    lists = (weights.states, weights.inputs, weights.disturbances, weights.noise)
    return (*lists, weights.bandwidth if weights.has("bandwidth") else None)


def _only_proper(weights: tuple[Any, ...], context: Context) -> bool:
    """Whether a bound holds only if no output passes to an input at once."""
    return not is_discrete(context.time) and weights[-1] is None


def _ratio_of(cost: Claim, bound: Claim, context: Context) -> Iterator[dict[str, Any]]:
    """The cost over the bound, and for which controllers, where both have the same weights."""
    weights = _weighed(cost.weights)
    if weights == _weighed(bound.weights) and bound.cost:
        yield {"ratio": cost.cost / bound.cost, "proper": _only_proper(weights, context)}


@RULES.rule("first", FIRST_COST, premises=("loop_cost", "cost_bound"))
def _first_cost(loop_cost: Claim, cost_bound: Claim, context: Context) -> Said:
    for values in _ratio_of(loop_cost, cost_bound, context):
        yield FIRST_COST(**values)


@RULES.rule("first", FIRST_MARGIN, premises=("input_margin", "output_margin"))
def _first_margin(input_margin: Claim, output_margin: Claim, context: Context) -> Said:
    """The least margin of a single input or output."""
    yield FIRST_MARGIN(margin=min(input_margin.margin, output_margin.margin))


@RULES.rule("first", FIRST_BOX, FIRST_RADII, FIRST_EXACT, premises=("box_stability",))
def _first_box(box_stability: Claim, context: Context) -> Said:
    """The plants whose loops are all stable."""
    _ = box_stability.bound
    if context.has("parameters"):
        return
    part = context.part_of_plant
    if part is None:
        yield FIRST_RADII()
    else:
        yield FIRST_BOX(part=part) if part or not is_sampled(context.system) else FIRST_EXACT()


@RULES.rule("first", FIRST_SAMPLED, premises=("loop",))
def _first_sampled(loop: Certified, context: Context) -> Said:
    """The step, and how late inputs are applied."""
    if is_sampled(context.system):
        how = loop.made_by(0)
        yield FIRST_SAMPLED(step=Fraction(how.step), late=how.late)


@RULES.rule("table", COST, premises=("loop_cost",))
def _cost(loop_cost: Claim, context: Context) -> Said:
    yield COST(cost=loop_cost.cost, weights=_weighed(loop_cost.weights))


@RULES.rule("table", BOUND, premises=("cost_bound",))
def _bound(cost_bound: Claim, context: Context) -> Said:
    weights = _weighed(cost_bound.weights)
    proper = _only_proper(weights, context)
    yield BOUND(cost=cost_bound.cost, proper=proper, weights=weights)


@RULES.rule("table", RATIO, premises=("loop_cost", "cost_bound"))
def _ratio(loop_cost: Claim, cost_bound: Claim, context: Context) -> Said:
    for values in _ratio_of(loop_cost, cost_bound, context):
        yield RATIO(**values)


@RULES.rule("table", GROUP_BOUND, premises=("graph_cost_bound",))
def _group_bound(graph_cost_bound: Claim, context: Context) -> Said:
    if graph_cost_bound.has("graph"):
        weights, edges = _weighed(graph_cost_bound.weights), graph_cost_bound.graph.edges
        proper = _only_proper(weights, context)
        cost = graph_cost_bound.cost
        yield GROUP_BOUND(cost=cost, proper=proper, edges=edges, weights=weights)


@RULES.rule("table", GROUP_RATIO, premises=("loop_cost", "graph_cost_bound"))
def _group_ratio(loop_cost: Claim, graph_cost_bound: Claim, context: Context) -> Said:
    if graph_cost_bound.has("graph"):
        for values in _ratio_of(loop_cost, graph_cost_bound, context):
            yield GROUP_RATIO(**values, edges=graph_cost_bound.graph.edges)


def _margin_rule(name: str) -> None:
    """Make the rule about a margin of inputs or outputs, each by itself or all together."""
    template, together = MARGINS[name], name.startswith("all")
    at = "inputs" if "input" in name else "outputs"

    @RULES.rule("table", template, premises=(name,))
    def _margin(margin: Claim, context: Context) -> Said:
        if margin.at == at and margin.together == together:
            yield template(margin=margin.margin)


for _name in MARGINS:
    _margin_rule(_name)


@RULES.rule(
    "table",
    ANOTHER_STEP,
    premises=("longest_step_input_margin", "longest_step_output_margin", "loop"),
)
def _another_step(inputs: Certified, outputs: Certified, loop: Certified, context: Context) -> Said:
    """The least margin of a single input or output, where samples are farther apart."""
    if is_sampled(context.system):
        step, *_ = (Fraction(each.made_by(0).step) for each in (inputs, outputs, loop))
        yield ANOTHER_STEP(margin=min(inputs.margin, outputs.margin), step=step)


@RULES.rule(
    "table",
    HELD,
    premises=("longest_step_input_margin", "longest_step_output_margin", "loop"),
)
def _at_samples(inputs: Certified, outputs: Certified, loop: Certified, context: Context) -> Said:
    """The least margin of a single input or output, where the controller runs at samples."""
    _ = loop.made_by(0).construction
    if not is_sampled(context.system):
        step, _ = (Fraction(each.made_by(0).step) for each in (inputs, outputs))
        yield HELD(margin=min(inputs.margin, outputs.margin), step=step)


def _step_rule(name: str, at: str) -> None:
    """Make the rule about the peak where a step is, which is the same in all units."""
    template = STEPS[name]

    @RULES.rule("table", template, premises=(name,))
    def _peaks(steps: Claim, context: Context) -> Said:
        if steps.at == at:
            rows = steps.inputs if at == "inputs" else steps.outputs
            own = [row[k] for k, row in enumerate(rows)]
            if own:
                yield template(peak=max(own))


for _name, _at in zip(STEPS, ("inputs", "outputs", "setpoints"), strict=True):
    _step_rule(_name, _at)


@RULES.rule("table", SECTORS, premises=("sector",))
def _sectors(sector: Claim, context: Context) -> Said:
    yield SECTORS(sectors=sector.sectors)
