"""Kind ``box_fixed``: no member of a box has a fixed mode; ``proofs/boxes.md``."""

from .arithmetic import Matrix, beside, diagonal, stack
from .boxes import Box, absolute
from .covers import require_covered
from .exterior_discs import discs_of_gains
from .reading import Json, fields, integer, items, malformed, matrices
from .region import no_fixed_mode, read_bound
from .regular_discs import Pencil, left_inverse
from .system import System


def check(claim: Json, witness: Json, box: Box) -> None:
    """Check that no λ of the spectrum of a member, outside of the region, is fixed for it.

    Theorem ``boxes.regular_not_fixed``.
    """
    (limit,) = fields(claim, "claim", "bound")
    bound = read_bound(limit, box)
    exterior, gains, listed, cover = fields(
        witness, "witness", "exterior", "gains", "frames", "cover"
    )
    discs = discs_of_gains(exterior, "witness.exterior", box)
    alone = Pencil(box.A, box.radii.A, box.n, [each.A for each in box.tied])
    given = enumerate(items(gains, "witness.gains"))
    pencils = [augmented(entry, f"witness.gains[{k}]", box) for k, entry in given]
    frames = []
    for k, entry in enumerate(items(listed, "witness.frames")):
        where = f"witness.frames[{k}]"
        number, V, w = fields(entry, where, "gains", "V", "w")
        if number is not None and integer(number, where) >= len(pencils):
            malformed(where, f"expected null or a position below {len(pencils)}")
        pencil = alone if number is None else pencils[number]
        frames.append(left_inverse(V, w, where, pencil))
    require_covered(cover, "witness.cover", discs, box.outside(bound), frames)


def augmented(value: Json, place: str, box: Box) -> Pencil:
    """[[A, B], [−XC, −W]] for X and W block diagonal by channel, and its radii."""
    p = [B_i.ncols for B_i in box.B]
    X_given, W_given = fields(value, place, "X", "W")
    shapes = [(p_i, C_i.nrows) for p_i, C_i in zip(p, box.C, strict=True)]
    X = matrices(X_given, f"{place}.X", shapes)
    W = matrices(W_given, f"{place}.W", [(p_i, p_i) for p_i in p])
    total, whole = sum(p), Matrix.zeros(0, 0)
    for W_i in W:
        whole = diagonal(whole, W_i.times(-1))

    def rows(A: Matrix, B: list[Matrix], C: list[Matrix], last: Matrix) -> Matrix:
        below = beside([stack(C, box.n), last], total)
        return stack([beside([A, *B], box.n), below], box.n + total)

    def of(system: System, last: Matrix) -> Matrix:
        XC = [(X_i @ C_i).times(-1) for X_i, C_i in zip(X, system.C, strict=True)]
        return rows(system.A, system.B, XC, last)

    moved = [absolute(X_i) @ D_i for X_i, D_i in zip(X, box.radii.C, strict=True)]
    zeros = Matrix.zeros(total, total)
    D = rows(box.radii.A, box.radii.B, moved, zeros)
    return Pencil(of(box, whole), D, box.n, [of(each, zeros) for each in box.tied])


def statement(claim: Json, box: Box) -> str:
    """What no member of the box has."""
    return f"{box.members}, there is {no_fixed_mode(claim['bound'], box)}"
