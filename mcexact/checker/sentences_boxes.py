"""What certificates about boxes imply: sentences about all members."""

from .sentence import DUAL, Premise, Role, restate
from .sentences_analysis import HAUTUS, WANG_DAVISON, everywhere, followed

MODES = Role(("box_fixed",))
CONTROLLED, OBSERVED = Role(("box_controllable",)), Role(("box_controllable",), DUAL)


def all_modes(found: Premise) -> bool:
    """Whether all channels act on every mode."""
    found.expect(everywhere(found), "not about all channels together")
    return found["bound"] is None


EACH = followed("each of them is stabilized by some decentralized controller of its own")
NOTHING = "boxes.regular_not_fixed"
restate("members-nothing-fixed", MODES, lambda c: c["bound"] is None, NOTHING)
restate("members-stabilizable", MODES, lambda c: True, WANG_DAVISON, EACH)
restate("members-controllable", CONTROLLED, all_modes, HAUTUS)
restate("members-observable", OBSERVED, all_modes, HAUTUS)
