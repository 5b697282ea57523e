"""What certificates about boxes imply: sentences about all members, or values in ranges."""

from fractions import Fraction

from . import budget
from .controller import MAPS
from .sentence import DUAL, Premise, Role, restate
from .sentences_analysis import HAUTUS, WANG_DAVISON, everywhere, followed
from .sentences_design import CLOSED, controller, signals
from .sparse import entries_of
from .system import System
from .uncertainty import read_radii


def all_modes(found: Premise) -> bool:
    """Whether all channels act on every mode."""
    found.expect(everywhere(found), "not about all channels together")
    return found["bound"] is None


NOTHING = "boxes.regular_not_fixed"
OWN = "is stabilized by some decentralized controller of its own"


def of_plants(stem: str, kinds: str, each: str) -> None:
    """Enter four rules about all plants within radii or ranges, and what follows of each."""
    modes, control = Role((f"{kinds}_fixed",)), f"{kinds}_controllable"
    restate(f"{stem}-nothing-fixed", modes, lambda c: c["bound"] is None, NOTHING)
    restate(f"{stem}-stabilizable", modes, lambda c: True, WANG_DAVISON, followed(each))
    restate(f"{stem}-controllable", Role((control,)), all_modes, HAUTUS)
    restate(f"{stem}-observable", Role((control,), DUAL), all_modes, HAUTUS)


of_plants("members", "box", f"each of them {OWN}")
of_plants("parametric-ranges", "parametric_box", f"each of these plants {OWN}")
HOLDS = "some decentralized controller of its own holds all outputs at any constant set-points"
restate(
    "members-setpoints",
    Role(("box_fixed",), (("integrators",),)),
    lambda c: True,
    f"{WANG_DAVISON}; E. J. Davison 1976",
    followed(f"so for each plant {HOLDS}"),
)


LOOPS = Role(("box_stable",), CLOSED)
Ratio = tuple[Fraction | int, Fraction | int]
"""A radius and the entry that it is of, which is not 0; or as many times both."""


def least(ratios: list[Ratio]) -> Fraction:
    """The largest number such that every radius is at least so many times the modulus."""
    longest = budget.limbs_of([number for pair in ratios for number in pair])
    budget.spend(budget.fractions(len(ratios), longest))
    return min((abs(Fraction(radius) / x) for radius, x in ratios), default=Fraction(0))


def of_plant(plant: System) -> list[Ratio]:
    """The radii of a plant beside its entries."""
    values, found = [plant.A, *plant.B, *plant.C], list[Ratio]()
    for M, D in zip(values, read_radii(plant.uncertainty, plant.names, values), strict=True):
        radii = {(i, j): radius for i, j, radius in entries_of(D)}
        d, e = M.denominator, D.denominator
        found += [(radii.get((i, j), 0) * d, x * e) for i, j, x in entries_of(M)]
    return found


def of_gains(loops: Premise) -> list[Ratio]:
    """The radii of the gains of a loop beside the gains; set-points are in no loop."""
    found = list[Ratio]()
    pairs = zip(controller([loops])[1], loops["gain_radii"]["agents"], strict=True)
    for agent, radii in ((agent[label], radii[label]) for agent, radii in pairs for label in MAPS):
        known, used = signals(radii), signals(agent)
        used.pop(("reference", ""), None)
        for signal, rows in used.items():
            gains = [x for row in rows for x in row]
            spread = [x for row in known.get(signal, []) for x in row] or [Fraction(0)] * len(gains)
            found += [pair for pair in zip(spread, gains, strict=True) if pair[1]]
    return found


def within(loops: Premise) -> str:
    """The claim, and changes of entries that it allows, whatever the radii are."""
    told = [f"in the plant by more than {least(of_plant(loops.plant))}"]
    if loops["gain_radii"] is not None:
        told.append(f"in the controller by more than {least(of_gains(loops))}")
    return (
        f"{loops.statement}; it holds if no entry changes {' and none '.join(told)} of its modulus"
    )


restate("members-in-region", LOOPS, lambda c: True)
restate("members-in-region-part", LOOPS, lambda c: True, words=within)
restate("parametric-ranges-in-region", Role(("parametric_box_stable",), CLOSED), lambda c: True)
