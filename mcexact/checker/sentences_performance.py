"""Rules of sentences about costs, bounds for every controller, margins, sectors, limits and steps.

Most repeat one claim.  The cost of a loop is set beside a bound only where both certificates have
the same weights: then the ratio of the two claims is at least that of the loop's cost and the cost
of any controller that the bound is about.  The first line of ``design`` and ``certify`` consists of
short sentences with rules of their own, since they say less than the rows of the table.
"""

from .controllers import read_controller
from .core import budget
from .core.budget import spend
from .core.reading import rational
from .kinds import same
from .sampling import is_held
from .sentences import ANOTHER_STEP, AT_SAMPLES, PLANT, Premise, Role, either, restate, rule
from .sentences_loops import CLOSED, LOOP, LOOPS, alone, within

COST, BOUND = Role(("loop_cost",), CLOSED), Role(("cost_bound",), PLANT)
MARGIN, MARGINS = (Role(("disk_margin",), CLOSED, many=many) for many in (False, True))
SATURATION = Role(("saturation",), CLOSED)
SECTOR, STEPS = Role(("sector",), CLOSED), Role(("step_peaks",), CLOSED)

restate("performance-cost", COST, lambda c: True)


def in_graph(bound: Premise) -> bool:
    """Whether a bound is about the controllers within a graph alone."""
    return "graph" in bound.document["claim"]


restate("performance-bound", BOUND, lambda c: not in_graph(c))
restate("performance-bound-graph", BOUND, in_graph)


def beside(cost: Premise, bounds: list[Premise], *, graph: bool) -> str:
    """Both claims, and the ratio of the two numbers."""
    fitting = [each for each in bounds if in_graph(each) == graph]
    whose = "within a graph" if graph else "for every controller"
    cost.expect(bool(fitting), f"expected a bound {whose}")
    bound = fitting[0]
    bound.expect(same(bound["weights"], cost["weights"]), "other weights")
    most, least = (rational(each["cost"], each.file) for each in (cost, bound))
    bound.expect(least > 0, "the bound is not above 0")
    spend(budget.fractions(1, budget.limbs_of([most, least])))
    beside = f"the cost of the former is at most {most / least} times that bound"
    return f"{cost.statement}; {bound.statement}: {beside}"


ANY_BOUND = Role(("cost_bound",), PLANT, many=True)


@rule("performance-ratio first-cost", COST, ANY_BOUND)
def _ratio(cost: Premise, bounds: list[Premise]) -> str:
    """The cost of the loop beside a bound for every controller."""
    return beside(cost, bounds, graph=False)


@rule("performance-ratio-graph", COST, ANY_BOUND)
def _group_ratio(cost: Premise, bounds: list[Premise]) -> str:
    """The cost of the loop beside a bound for the controllers within a graph."""
    return beside(cost, bounds, graph=True)


def of_ports(key: str, at: str, *, together: bool) -> None:
    """Enter the rule about a margin of inputs or outputs, each by itself or all together."""
    restate(key, MARGIN, lambda c: c["at"] == at and c["together"] == together)


of_ports("performance-input-margin", "inputs", together=False)
of_ports("performance-output-margin", "outputs", together=False)
of_ports("performance-all-inputs-margin", "inputs", together=True)
of_ports("performance-all-outputs-margin", "outputs", together=True)


def each_port(margins: list[Premise]) -> str:
    """A margin of each input by itself, and one of each output by itself."""
    sides = {each["at"]: each for each in margins}
    margins[0].expect(len(sides) == 2, "expected a margin of inputs and one of outputs")
    inputs, outputs = sides["inputs"], sides["outputs"]
    least = min(rational(each["margin"], each.file) for each in (inputs, outputs))
    both = f"{inputs.statement}; {outputs.statement}"
    return f"{both}: each input and each output by itself has a disk margin of at least {least}"


@rule("first-margin", MARGINS, MARGINS)
def _every_loop(margins: list[Premise], _: list[Premise]) -> str:
    """The margins of all inputs and outputs.

    Both roles are played by all margins; the claims say which are of inputs and which of outputs.
    """
    return each_port(margins)


AGAIN = Role(("disk_margin",), ((ANOTHER_STEP, *CLOSED[0]),), many=True)


@rule("performance-another-step", AGAIN, AGAIN, LOOP)
def _another_step(margins: list[Premise], _: list[Premise], loop: Premise) -> str:
    """The margins with another step between the samples, and with the same controller."""
    again, own = (each.document["subject"] for each in (margins[0], loop))
    margins[0].expect(same(again[1:], own[1:]), "another controller")
    return f"{each_port(margins)}, with the controller for the step {own[0]['step']}"


HELD = Role(("disk_margin",), (AT_SAMPLES,), many=True)


def held_from(at_samples: Premise, loop: Premise) -> bool:
    """Whether a loop of samples has a controller in continuous time by Tustin's rule."""
    (sampling, again), (own,) = (each.document["subject"] for each in (at_samples, loop))
    programs = [
        read_controller(step["controller"], at_samples.file, at_samples.plant)
        for step in (own, again)
    ]
    h = rational(sampling["step"], at_samples.file)
    return is_held(programs[0], programs[1], at_samples.plant, h)


@rule("performance-at-samples", HELD, HELD, LOOP)
def _at_samples(margins: list[Premise], _: list[Premise], loop: Premise) -> str:
    """The margins of the loop in continuous time with its controller at samples, without delay."""
    first = margins[0]
    first.expect(first.document["subject"][0]["late"] == 0, "inputs are applied late")
    first.expect(held_from(first, loop), "another controller than that of the loop at samples")
    sampling = first.document["subject"][0]
    held = f"its controller, which acts every {sampling['step']} units of time, is that of the loop"
    rounded = f"rounded to 12 digits, its plant to {sampling['decimals']} decimals"
    return f"{each_port(margins)}; {held} in continuous time by Tustin's rule, {rounded}"


def own_peak(peaks: Premise) -> str:
    """The claim, and the largest bound of a signal where a step is."""
    rows = peaks["inputs" if peaks["at"] == "inputs" else "outputs"]
    own = [rational(row[k], peaks.file) for k, row in enumerate(rows)]
    spend(budget.fractions(len(own), budget.limbs_of(own)))
    each = {"inputs": "input k", "outputs": "output k", "setpoints": "output k"}[peaks["at"]]
    return f"{peaks.statement}: for every k, the bound of the {each} is at most {max(own)}"


def of_steps(key: str, at: str) -> None:
    """Enter the rule about steps at inputs, at outputs, or of set-points."""
    restate(key, STEPS, lambda c: c["at"] == at and len(c["inputs"]) > 0, words=own_peak)


of_steps("performance-input-steps", "inputs")
of_steps("performance-output-steps", "outputs")
of_steps("performance-setpoint-steps", "setpoints")
restate("performance-sectors", SECTOR, lambda c: True)


def everywhere(premise: Premise) -> bool:
    """Whether a loop is stable from all states with its inputs cut off."""
    return "region" not in premise.document["claim"]


either("saturation-global", "saturation-region", SATURATION, everywhere)
either("first-saturation", "first-saturation-region", SATURATION, everywhere)
restate("first-box", LOOPS, lambda c: True, words=within)
restate("first-radii", LOOPS, lambda c: True)
restate("first-exact", LOOPS, alone)
