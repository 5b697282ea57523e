"""How far the paper's bounds can be from the least common dimension: answer and sentences.

The bounds are (26) of Theorem 2 and (27) of Remark 2.  Over one neighbor graph the first is at most
β times the least common dimension of any plant, the second at most m − γ times, and some plant
attains either.  The answer `SharingGap` has these two numbers of the graph, with sets of agents
that attain them.  Its sentences are about the graph alone, and about a plant whose bound and least
common dimension are certified as well.
"""

from __future__ import annotations

from mcexact.answer.analysis import Said
from mcexact.answer.evidence import Tree
from mcexact.answer.protocol import Answer, answer, claim, shown, witness
from mcexact.answer.sentence import Claim, Context, Rulebook
from mcexact.answer.templates import Template

# Answer: the factors of a neighbor graph.


@answer("sharing_gap")
class SharingGap(Answer):
    """Over this graph (26) is at most β times the least common dimension, (27) at most m − γ times.

    Sets S and R of agents are apart if no agent of S receives messages of an agent of R.  A relay
    of them is an agent of which S receives messages, and which receives messages of R.

    Attributes
    ----------
    relays, relays_at_most : int
        The first is the number of relays of ``receivers`` and ``senders``; β, the most relays of
        any two sets that are apart, is from the first to the second.
    boundary, boundary_at_most : int
        The first is the number of agents outside ``dominating``; m − γ, the most agents in any
        N_s∖s, is from the first to the second.
    receivers, senders : tuple of str
        Sets S and R that are apart; both are empty if β is 0.
    dominating : tuple of str
        A set s with N_s = {1, …, m}; γ is the least size of such a set.
    tree : Tree
        The proof that no dominating set has fewer than m − ``boundary_at_most`` agents.
    """

    relays: int = claim("relays between sets that are apart")
    relays_at_most: int = claim("relays at most")
    boundary: int = claim("agents in a boundary")
    boundary_at_most: int = claim("agents in a boundary at most")
    receivers: tuple[str, ...] = witness()
    senders: tuple[str, ...] = witness()
    dominating: tuple[str, ...] = witness()
    tree: Tree = witness()

    @property
    @shown()
    def exact(self) -> bool:
        """Whether both numbers are known exactly, and not only within bounds."""
        return (self.relays, self.boundary) == (self.relays_at_most, self.boundary_at_most)

    @property
    @shown()
    def always_right(self) -> tuple[bool, bool]:
        """Whether (26) and (27) are the least common dimension of every plant over this graph."""
        return self.relays_at_most <= 1, self.boundary_at_most <= 1


# Sentences about the graph, and about the bound of a plant.

OUTPUTS, STATES = "outputs+states", "states"
_AT_MOST = {
    OUTPUTS: "sharing_gap.bound_26_at_most",
    STATES: "sharing_gap.bound_27_at_most",
}
FACTORS = Template(
    "sharing-gap",
    "at most {relays:int} times the least common dimension (Theorem 2), at most {boundary:int} "
    "times without outputs (Remark 2)",
    ", ".join(_AT_MOST.values()),
    "bounds over this graph",
)
_BOUNDS = {OUTPUTS: "Theorem 2's bound", STATES: "Remark 2's bound"}
_REASONS = {
    OUTPUTS: "at most {factor:count agent} can relay between two sets of agents of which one "
    "receives nothing from the other",
    STATES: "at most {factor:count agent} can be outside a set of agents and send to it",
}


def _compared(key: str, share: str, label: str = "") -> Template:
    """The sentence that compares the bound of a plant with its least common dimension."""
    subject = "" if label else f"{_BOUNDS[share]} is "
    text = (
        f"{subject}{{k:count state}} by each agent, and {{c:int}} the least; over this graph "
        f"it is never more than {{factor:int}} times the least, since {_REASONS[share]}"
    )
    return Template(f"{key}-{share.replace('+', '-')}", text, _AT_MOST[share], label)


TABLE = {share: _compared("bound-and-least", share, _BOUNDS[share]) for share in _BOUNDS}
NOTE = {share: _compared("allocate-bound-and-least", share) for share in _BOUNDS}

GAP_RULES = Rulebook()
"""Rules of the table of `mcexact analyze`."""
NOTE_RULES = Rulebook()
"""Rules of `mcexact allocate`."""


@GAP_RULES.rule("table", FACTORS, premises=("sharing_gap",))
def _factors(sharing_gap: Claim, context: Context) -> Said:
    yield FACTORS(relays=sharing_gap.relays_at_most, boundary=sharing_gap.boundary_at_most)


def _said(template: Template, share: str, bound: Claim, common: Claim, gap: Claim) -> Said:
    """Compare a bound with the least common dimension, if that is the one and at least 1."""
    made = [step["construction"] for step in bound.subject]
    fits = made == ["augmented_outputs"] * (share == OUTPUTS)
    if fits and common.share == share and common.dimension:
        factor = gap.relays_at_most if share == OUTPUTS else gap.boundary_at_most
        yield template(k=bound.deficiency, c=common.dimension, factor=factor)


def _rules(share: str) -> None:
    """Make the rules of the comparison for one way of sharing."""
    stem = share.replace("+", "_")

    @GAP_RULES.rule(
        "table",
        TABLE[share],
        premises=(f"shared_dimension_bound_{stem}", f"common_dimension_{stem}", "sharing_gap"),
    )
    def _in_the_table(bound: Claim, common: Claim, gap: Claim, context: Context) -> Said:
        yield from _said(TABLE[share], share, bound, common, gap)

    @NOTE_RULES.rule(
        "bound and least",
        NOTE[share],
        premises=("shared_dimension_bound", "common_dimension", "sharing_gap"),
    )
    def _in_the_note(bound: Claim, common: Claim, gap: Claim, context: Context) -> Said:
        yield from _said(NOTE[share], share, bound, common, gap)


for way in _BOUNDS:
    _rules(way)
