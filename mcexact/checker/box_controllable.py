"""Kind ``box_controllable``: channels control every member of a box; ``proofs/boxes.md``."""

from dataclasses import replace

from .arithmetic import Matrix, beside
from .boxes import Box
from .covers import require_covered
from .evidence import inputs
from .exterior_discs import discs_of_gains
from .parametric_system import FunctionSystem
from .reading import Json, fields, items, names
from .region import inside, read_bound
from .regular_discs import Pencil, right_inverse
from .statement import channel_set
from .system import System


def check(claim: Json, witness: Json, box: Box) -> None:
    """Check that [λI − A, B_T] has full rank at every λ, outside of the region, for all members.

    Theorems ``joint_controllability.controllable_hautus``, ``boxes.uncontrolled_fixed``.
    """
    listed, limit = fields(claim, "claim", "channels", "bound")
    channels, bound = names(listed, "claim.channels", box.names), read_bound(limit, box)
    exterior, frames, cover = fields(witness, "witness", "exterior", "frames", "cover")
    every = (box, box.radii, *box.tied)
    Z, D, *moved = (beside([each.A, inputs(each, channels)], box.n) for each in every)
    # what the channels do not control no gains from the state move
    certain = [Matrix.zeros(box.n, box.n)]
    radii, *tied = (replace(each, B=[inputs(each, channels)], C=certain) for each in every[1:])
    B, C = [inputs(box, channels)], [Matrix.unit_rows(box.n, 0, box.n)]
    measured = replace(box, names=[""], B=B, C=C, radii=radii, tied=tuple(tied))
    discs = discs_of_gains(exterior, "witness.exterior", measured)
    found = []
    for k, entry in enumerate(items(frames, "witness.frames")):
        where = f"witness.frames[{k}]"
        R, w = fields(entry, where, "R", "w")
        found.append(right_inverse(R, w, where, Pencil(Z, D, box.n, moved)))
    require_covered(cover, "witness.cover", discs, box.outside(bound), found)


def statement(claim: Json, box: Box) -> str:
    """What the channels control."""
    return controls(claim, box, box.members)


def controls(claim: Json, box: System | FunctionSystem, members: str) -> str:
    """What the channels control of these members."""
    channels, bound = channel_set(claim["channels"]), claim["bound"]
    where = "" if bound is None else f" of {inside(bound, box).replace('below', 'at least')}"
    return f"{members}, the channels {channels} together control every mode{where}"
