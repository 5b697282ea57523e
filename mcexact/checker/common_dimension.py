"""Kind ``common_dimension``: the least common dimension; ``proofs/common_dimension.md``."""

from . import reading, region
from .information_structure import SHARED, augmented_outputs, extended, neighbors_of
from .reading import Json, fields, require
from .shared_dimensions import read_cut
from .statement import FIXED
from .system import System


def check(claim: Json, witness: Json, system: System) -> None:
    """Check that k dimensions of each agent suffice, and that for one subset k − 1 do not.

    Theorems ``shared_dimensions.common_dimension_outputs``,
    ``shared_dimensions.common_dimension_states``, ``shared_dimensions.frees_more``,
    ``shared_dimensions.frees_states_more``, ``shared_dimensions.no_common_dimension_outputs``,
    ``shared_dimensions.no_common_dimension_states``.
    """
    share, listed, number = fields(claim, "claim", "share", "feasible", "dimension")
    absence, cut = fields(witness, "witness", "absence", "cut")
    reading.string(share, "claim.share", *SHARED)
    feasible, N = reading.boolean(listed, "claim.feasible"), neighbors_of(system, "claim")
    k = 0
    if feasible:
        k = reading.integer(number, "claim.dimension")
        step = {"share": share, "dimensions": [k] * system.m}
        region.require_absence(absence, extended(system, step, "claim.dimension"), None)
    else:
        nothing = number is None and absence is None
        require(nothing, "claim", "claim", "expected null where nothing suffices")
    needed = not feasible or k > 0
    require((cut is not None) == needed, "cut", "witness.cut", "expected unless 0 suffices")
    if needed:
        outputs = share == "outputs+states"
        base = augmented_outputs(system, {}, "claim.share") if outputs else system
        s, lost = read_cut(cut, "witness.cut", base, None, False)
        around = len({j for i in s for j in N[i]} - set(s))
        short = around * (k - 1) < lost if feasible else around == 0
        require(short, "cut", "witness.cut", f"{around} agents around the subset can do with less")


def statement(claim: Json, system: System) -> str:
    """For which common dimensions no mode is fixed."""
    when = f"exactly for k >= {claim['dimension']}" if claim["feasible"] else "for no k"
    what = f"{SHARED[claim['share']]} of dimension k for each agent"
    return f"the extended system without delays sharing {what} has no mode that is {FIXED} {when}"
