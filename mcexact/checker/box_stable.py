"""Kind ``box_stable``: every eigenvalue of every member lies in a region; ``proofs/boxes.md``."""

from fractions import Fraction
from itertools import pairwise
from operator import mul

from . import budget, stability
from .arithmetic import Matrix
from .boxes import Box, absolute
from .complex_matrices import magnitude
from .controller import MAPS, read_controller
from .function_loops import FunctionLoop
from .loop_pencil import loop_pencil
from .parametric_system import FunctionSystem
from .reading import Json, fields, integer, items, malformed, rational, require
from .region import inside, read_bound
from .regular_discs import Pencil, left_inverse, read_weights
from .root_discs import Disc
from .statement import canonical_json, with_digest
from .system import System
from .uncertainty import Pair, pairs_of, radii_in_words


def check(claim: Json, witness: Json, box: Box) -> None:
    """Check the values themselves, and that no eigenvalue crosses the border of the region.

    Theorems ``box_stable.box_stable_continuous``, ``box_stable.box_stable_discrete``.
    """
    limit, gain_radii = fields(claim, "claim", "bound", "gain_radii")
    given = read_bound(limit, box)
    bound = Fraction(int(box.time == "discrete")) if given is None else given
    keys = ("nominal", "points", "growth", "segments", "frames")
    nominal, listed, growth, used, frames = fields(witness, "witness", *keys)
    stability.check({"bound": limit, "stable": True}, nominal, box)
    pencil = loop_pencil(box, gain_radii)
    ends = [rational(point, "witness.points") for point in items(listed, "witness.points")]
    segments = segments_of(box.time, bound, ends)
    if box.time == "continuous":
        _require_growth(growth, pencil, ends[-1] if ends else Fraction(0))
    else:
        require(growth is None, "growth", "witness.growth", "expected null in discrete time")
    found = []
    for k, entry in enumerate(items(frames, "witness.frames")):
        where = f"witness.frames[{k}]"
        V, w = fields(entry, where, "V", "w")
        found.append(left_inverse(V, w, where, pencil))
    for k, number in enumerate(items(used, "witness.segments", len(segments))):
        where = f"witness.segments[{k}]"
        if integer(number, where) >= len(found):
            malformed(where, f"expected a position below {len(found)}")
        require(found[number](*segments[k]), "segment", where, "not regular by this frame")


def segments_of(time: str, bound: Fraction, ends: list[Fraction]) -> list[Disc]:
    """Discs with the upper half of the border of the region, as far as the last end.

    Theorems ``arcs.upper_line``, ``arcs.upper_half``.
    """
    points = [Fraction(0), *ends]
    rises = all(a < b for a, b in pairwise(points))
    require(rises, "points", "witness.points", "expected increasing numbers above 0")
    if time == "continuous":
        return [(-bound, (a + b) / 2, (b - a) / 2) for a, b in pairwise(points)]
    edge = [_on_circle(bound, t) for t in points] + [(-bound, Fraction(0))]
    return [_arc(*pair) for pair in pairwise(edge)]


def _on_circle(bound: Fraction, t: Fraction) -> tuple[Fraction, Fraction]:
    """The point of the circle of this radius whose half angle has the tangent t.

    Theorem ``arcs.circle_point``.
    """
    budget.spend(budget.fractions(8, 3 * budget.limbs_of([bound, t])))
    return bound * (1 - t * t) / (1 + t * t), bound * 2 * t / (1 + t * t)


def _arc(p: tuple[Fraction, Fraction], q: tuple[Fraction, Fraction]) -> Disc:
    """The disc whose diameter is the chord, with the radius rounded up.

    Theorems ``arcs.arc_in_disc``, ``arcs.last_arc_in_disc``.
    """
    longest = 4 * budget.limbs_of([*p, *q])
    budget.spend(budget.fractions(10, longest) + budget.reductions(1, 2 * longest))
    x, y = (p[0] - q[0]) / 2, (p[1] - q[1]) / 2
    d = x.denominator * y.denominator << 32
    return (p[0] + q[0]) / 2, (p[1] + q[1]) / 2, Fraction(magnitude(int(x * d), int(y * d)), d)


def _require_growth(value: Json, pencil: Pencil, R: Fraction) -> None:
    """Stop unless positive weights of the states exclude every eigenvalue of modulus R or more.

    Theorem ``boxes.growth``.
    """
    n, place = pencil.dynamic, "witness.growth"
    most = sum(map(absolute, pencil.tied), absolute(pencil.Z) + pencil.D)
    sizes = [Fraction(row[0]) for row in read_weights(value, place, n).rows]
    for row in most.rows[n:]:
        # the signals before it, of which such a row computes the next one
        longest = 2 * (most.limbs + budget.limbs_of(sizes))
        budget.spend(budget.fractions(2 * len(sizes), longest))
        sizes.append(sum(map(mul, row, sizes), Fraction(0)) / most.denominator)
    longest = 2 * (most.limbs + budget.limbs_of([*sizes, R]))
    budget.spend(budget.fractions(2 * n * len(sizes), longest))
    R *= most.denominator
    slower = all(sum(map(mul, most.rows[i], sizes)) < R * sizes[i] for i in range(n))
    require(slower, "growth", place, "does not exclude all eigenvalues beyond the last point")


def statement(claim: Json, box: Box) -> str:
    """Where all eigenvalues of all members lie."""
    return lie_inside(claim, box, box.members)


def lie_inside(claim: Json, box: System | FunctionSystem, members: str) -> str:
    """Where all eigenvalues of these members lie."""
    limit, radii = claim["bound"], claim["gain_radii"]
    bound = int(box.time == "discrete") if limit is None else limit
    gains = ""
    if radii is not None:
        given = canonical_json(read_controller(radii, "claim.gain_radii"))
        programs = box.programs if isinstance(box, Box | FunctionLoop) else None
        near = radii_in_words(gain_pairs(programs, radii), "their radii")
        which = f"those of the controller {near}, the radii being those with {with_digest(given)}"
        gains = f", and for all controllers whose entries differ from {which}"
    return f"{members}{gains}, every eigenvalue of A has {inside(bound, box)}"


def gain_pairs(programs: Json, radii: Json) -> list[Pair]:
    """The radii of the gains of a controller; those of set-points are in no loop."""
    known, spread = (read_controller(value, "controller")["agents"] for value in (programs, radii))
    nominal, found = list[Matrix](), list[Matrix]()
    for pair in zip(known, spread, strict=True):
        for label in MAPS:
            M, D = (_signals(agent.get(label, {})) for agent in pair)
            for signal in {**M, **D}:
                some = M.get(signal) or D[signal]
                zeros = Matrix.zeros(some.nrows, some.ncols)
                nominal.append(M.get(signal, zeros))
                found.append(D.get(signal, zeros))
    return pairs_of(nominal, found)


def _signals(program: Json) -> dict[tuple[str, str], Matrix]:
    """The matrices of a program that are in the loop, by the signal that each multiplies."""
    used = {("private", ""): program["private"]} if "private" in program else {}
    for key in ("outputs", "shared"):
        used |= {(key, name): M for name, M in program.get(key, {}).items()}
    return used
