"""Rules of sentences about costs, bounds for every controller, margins, sectors and steps.

Most repeat one claim.  The cost of a loop is set beside a bound only where both certificates have
the same weights: then the ratio of the two claims is at least that of the loop's cost and the cost
of any controller that the bound is about.  The first line of ``design`` and ``certify`` consists of
short sentences with rules of their own, since they say less than the rows of the table.
"""

from fractions import Fraction

from . import budget
from .budget import spend
from .kinds import same
from .reading import rational
from .sentences import PLANT, Premise, Role, restate, rule
from .sentences_loops import CLOSED, LOOPS, within

COST, BOUND = Role(("loop_cost",), CLOSED), Role(("cost_bound",), PLANT)
MARGIN, MARGINS = (Role(("disk_margin",), CLOSED, many=many) for many in (False, True))
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
    return (
        f"{cost.statement}; {bound.statement}: the former is at most {most / least} of the latter"
    )


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


@rule("first-margin", MARGINS, MARGINS)
def _every_loop(margins: list[Premise], _: list[Premise]) -> str:
    """A margin of each input by itself, and one of each output by itself.

    Both roles are played by all margins; the claims say which are of inputs and which of outputs.
    """
    sides = {each["at"]: each for each in margins}
    margins[0].expect(len(sides) == 2, "expected a margin of inputs and one of outputs")
    inputs, outputs = sides["inputs"], sides["outputs"]
    least = min(rational(each["margin"], each.file) for each in (inputs, outputs))
    both = f"{inputs.statement}; {outputs.statement}"
    return f"{both}: each input and each output by itself has a disk margin of at least {least}"


def largest(peaks: Premise) -> str:
    """The claim, and the largest bounds of inputs and of outputs."""
    tables = [
        [[rational(x, peaks.file) for x in row] for row in peaks[key]]
        for key in ("inputs", "outputs")
    ]
    every = [[x for row in table for x in row] or [Fraction(0)] for table in tables]
    spend(budget.fractions(2 * sum(map(len, every)), max(map(budget.limbs_of, every))))
    said = f"the largest bound of an input is {max(every[0])}, of an output {max(every[1])}"
    if peaks["at"] == "setpoints":
        own = max(row[k] for k, row in enumerate(tables[1]))
        said += f", and of the output whose set-point is 1 {own}"
    return f"{peaks.statement}: {said}"


def of_steps(key: str, at: str) -> None:
    """Enter the rule about steps at inputs, at outputs, or of set-points."""
    restate(key, STEPS, lambda c: c["at"] == at and len(c["inputs"]) > 0, words=largest)


of_steps("performance-input-steps", "inputs")
of_steps("performance-output-steps", "outputs")
of_steps("performance-setpoint-steps", "setpoints")
restate("performance-sectors", SECTOR, lambda c: True)
restate("first-box", LOOPS, lambda c: True, words=within)
restate("first-radii", LOOPS, lambda c: True)
