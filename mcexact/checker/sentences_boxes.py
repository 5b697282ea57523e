"""What certificates about boxes imply: sentences about all members, or values in ranges."""

from fractions import Fraction

from . import budget
from .box_stable import gain_pairs
from .sentence import DUAL, Premise, Role, restate
from .sentences_analysis import HAUTUS, WANG_DAVISON, everywhere, followed
from .sentences_design import CLOSED
from .uncertainty import Pair, pairs_of, read_radii


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


def least(pairs: list[Pair]) -> Fraction:
    """The largest number such that every radius is at least so many times the absolute value."""
    longest = budget.limbs_of([number for pair in pairs for number in pair])
    budget.spend(budget.fractions(len(pairs), longest))
    return min((radius / value for radius, value in pairs if value), default=Fraction(0))


def within(loops: Premise) -> str:
    """The claim, and changes of entries that it allows, whatever the radii are."""
    plant, radii = loops.plant, loops["gain_radii"]
    nominal = [plant.A, *plant.B, *plant.C]
    spread = read_radii(plant.uncertainty, plant.names, nominal)
    told = [f"in the plant by more than {least(pairs_of(nominal, spread))}"]
    if radii is not None:
        pairs = gain_pairs(loops.document["subject"][-1]["controller"], radii)
        told.append(f"in the controller by more than {least(pairs)}")
    return (
        f"{loops.statement}; it holds if no entry changes {' and none '.join(told)} of its modulus"
    )


restate("members-in-region", LOOPS, lambda c: True)
restate("members-in-region-part", LOOPS, lambda c: True, words=within)
restate("parametric-ranges-in-region", Role(("parametric_box_stable",), CLOSED), lambda c: True)
