"""Kinds about every plant in a box, or at all values of parameters in ranges.

Three properties are checked for every member of a box: no mode is fixed (``box_fixed``), channels
control every mode (``box_controllable``), and every eigenvalue lies in a region (``box_stable``).
The first two require a pencil to have full rank at every λ that can be an eigenvalue of a member
and lies outside of the allowed region: `discs` bounds these λ by discs, which it covers by cells.
The third one checks the loop at its nominal values, and that no eigenvalue of a member crosses the
border of the region, which is covered by discs, too.

The kinds ``parametric_box_…`` are about the values of parameters in ranges.  The ranges are cut
into cells (`cells`), and the same checks run for a box around the plants of each cell.
"""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from operator import mul

from . import loops
from .cells import FunctionLoop, boxes_of_cells, ranges_text
from .constructions import ports_of
from .controllers import MAPS, read_controller
from .core import budget
from .core.arithmetic import Matrix, absolute, beside, diagonal, stack
from .core.evidence import inputs
from .core.reading import (
    Json,
    fields,
    integer,
    items,
    malformed,
    matrices,
    names,
    rational,
    require,
    string,
)
from .core.roots import Disc
from .core.system import System, canonical_json, channel_set, with_digest
from .discs import (
    Box,
    Pair,
    Pencil,
    Regular,
    complex_matrix,
    discs_of_gains,
    inverse_multiplied,
    left_inverse,
    loop_pencil,
    magnitude,
    multiplied,
    pairs_of,
    radii_in_words,
    read_weights,
    regular_by,
    require_covered,
    right_inverse,
)
from .modes import inside, no_fixed_mode, read_rate_or_radius
from .parametric_system import FunctionSystem
from .performance import PORTS, diagonal_of

# Kind ``box_fixed``: no member of a box has a fixed mode; ``proofs/boxes.md``.


def check_box_fixed(claim: Json, witness: Json, box: Box) -> None:
    """Check that no λ of the spectrum of a member, outside of the region, is fixed for it.

    Theorem ``boxes.regular_not_fixed``.
    """
    (limit,) = fields(claim, "claim", "bound")
    bound = read_rate_or_radius(limit, box)
    exterior, gains, listed, cover = fields(
        witness, "witness", "exterior", "gains", "frames", "cover"
    )
    discs = discs_of_gains(exterior, "witness.exterior", box)
    alone = Pencil(box.A, box.radii.A, box.n, [each.A for each in box.tied])
    entries = enumerate(items(gains, "witness.gains"))
    pencils = [augmented(entry, f"witness.gains[{k}]", box) for k, entry in entries]
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

    radii_of_XC = [absolute(X_i) @ D_i for X_i, D_i in zip(X, box.radii.C, strict=True)]
    zeros = Matrix.zeros(total, total)
    D = rows(box.radii.A, box.radii.B, radii_of_XC, zeros)
    return Pencil(of(box, whole), D, box.n, [of(each, zeros) for each in box.tied])


def box_fixed_statement(claim: Json, box: Box) -> str:
    """The words of the claim that no member of the box has a fixed mode."""
    return f"{box.members}, there is {no_fixed_mode(claim['bound'], box)}"


# Kind ``box_controllable``: channels control every member of a box; ``proofs/boxes.md``.


def check_box_controllable(claim: Json, witness: Json, box: Box) -> None:
    """Check that [λI − A, B_T] has full rank at every λ, outside of the region, for all members.

    Theorems ``joint_controllability.controllable_hautus``, ``boxes.uncontrolled_fixed``.
    """
    listed, limit = fields(claim, "claim", "channels", "bound")
    channels, bound = names(listed, "claim.channels", box.names), read_rate_or_radius(limit, box)
    exterior, frames, cover = fields(witness, "witness", "exterior", "frames", "cover")
    every = (box, box.radii, *box.tied)
    Z, D, *tied_pencils = (beside([each.A, inputs(each, channels)], box.n) for each in every)
    # what the channels do not control no gains from the state move
    certain = [Matrix.zeros(box.n, box.n)]
    radii, *tied = (replace(each, B=[inputs(each, channels)], C=certain) for each in every[1:])
    B, C = [inputs(box, channels)], [Matrix.unit_rows(box.n, 0, box.n)]
    measured = replace(box, names=[""], B=B, C=C, radii=radii, tied=tuple(tied))
    discs = discs_of_gains(exterior, "witness.exterior", measured)
    inverses = []
    for k, entry in enumerate(items(frames, "witness.frames")):
        where = f"witness.frames[{k}]"
        R, w = fields(entry, where, "R", "w")
        inverses.append(right_inverse(R, w, where, Pencil(Z, D, box.n, tied_pencils)))
    require_covered(cover, "witness.cover", discs, box.outside(bound), inverses)


def box_controllable_statement(claim: Json, box: Box) -> str:
    """What the channels control."""
    return controls(claim, box, box.members)


def controls(claim: Json, box: System | FunctionSystem, members: str) -> str:
    """The words for which modes of these members the channels control."""
    channels, bound = channel_set(claim["channels"]), claim["bound"]
    where = "" if bound is None else f" of {inside(bound, box).replace('below', 'at least')}"
    return f"{members}, the channels {channels} together control every mode{where}"


# Kind ``box_stable``: every eigenvalue of every member lies in a region; ``proofs/boxes.md``.


def check_box_stable(claim: Json, witness: Json, box: Box) -> None:
    """Check the values themselves, and that no eigenvalue crosses the border of the region.

    With a ``disk`` this is also for each input, or each output, multiplied by complex numbers.

    Theorems ``box_stable.box_stable_continuous``, ``box_stable.box_stable_discrete``,
    ``box_disk.box_disk_continuous``, ``box_disk.box_disk_discrete``.
    """
    limit, gain_radii, disk = fields(claim, "claim", "bound", "gain_radii", optional=("disk",))
    rate = read_rate_or_radius(limit, box)
    bound = Fraction(int(box.time == "discrete")) if rate is None else rate
    keys = ("nominal", "points", "growth", "segments", "frames")
    nominal, listed, growth, used, frames = fields(witness, "witness", *keys)
    loops.check_stability({"bound": limit, "stable": True}, nominal, box)
    pencil = loop_pencil(box, gain_radii)
    ports, alpha = ([], Fraction(0)) if disk is None else read_disk(disk, box, pencil)
    pencils = [multiplied(pencil, k, alpha) for k in ports]
    ends = [rational(point, "witness.points") for point in items(listed, "witness.points")]
    segments = segments_of(box.time, bound, ends)
    if box.time == "continuous":
        last = ends[-1] if ends else Fraction(0)
        _require_growth(growth, pencil, last, ports, (1 + alpha / 2) / (1 - alpha / 2))
    else:
        require(growth is None, "growth", "witness.growth", "expected null in discrete time")
    regular = []
    for k, entry in enumerate(items(frames, "witness.frames")):
        where = f"witness.frames[{k}]"
        V, w = fields(entry, where, "V", "w")
        if disk is None:
            regular.append(left_inverse(V, w, where, pencil))
        else:
            regular.append(_of_every_port(V, w, where, ports, pencils))
    for k, number in enumerate(items(used, "witness.segments", len(segments))):
        where = f"witness.segments[{k}]"
        if integer(number, where) >= len(regular):
            malformed(where, f"expected a position below {len(regular)}")
        require(regular[number](*segments[k]), "segment", where, "not regular by this frame")


def read_disk(value: Json, box: Box, pencil: Pencil) -> tuple[list[int], Fraction]:
    """The places, among the signals of a loop, of its inputs or outputs, and the margin."""
    side, size = fields(value, "claim.disk", "at", "margin")
    at, alpha = string(side, "claim.disk.at", *PORTS), rational(size, "claim.disk.margin")
    # at α = 2 the disk contains δ = 2, where (1 + δ/2)/(1 − δ/2) is not defined
    require(0 < alpha < 2, "margin", "claim.disk.margin", "expected a number above 0, below 2")
    require(box.plant is not None, "claim", "claim.disk", "expected none without a controller")
    plant = box if box.plant is None else box.plant
    p, q = ports_of(plant)
    size_of_all = pencil.Z.nrows
    first = size_of_all - p - q if at == "outputs" else size_of_all - p
    ports = [*range(first, first + (q if at == "outputs" else p))]
    # without a port nothing would be proved about the loop itself
    require(bool(ports), "ports", "claim.disk.at", "the loop has none")
    return ports, alpha


def _of_every_port(
    value: Json, weights: Json, place: str, ports: list[int], pencils: list[Pencil]
) -> Regular:
    """The discs on which one V, with weights for each port, proves all pencils to be regular.

    V is about the inverse of the loop's own pencil, from which that of each port is made.
    """
    size = pencils[0].Z.nrows
    V = complex_matrix(value, place, size - 2, size - 2)
    tests = []
    listed = zip(items(weights, f"{place}.w", len(ports)), ports, pencils, strict=True)
    for w, k, pencil in listed:
        heavy = read_weights(w, f"{place}.w", size)
        tests.append(regular_by(inverse_multiplied(V, k), heavy, pencil))
    return lambda re, im, rho: all(test(re, im, rho) for test in tests)


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


def _require_growth(
    value: Json,
    pencil: Pencil,
    R: Fraction,
    ports: Sequence[int] = (),
    largest: Fraction = Fraction(1),
) -> None:
    """Stop unless positive weights of the states exclude every eigenvalue of modulus R or more.

    What the signals at ``ports`` are multiplied by is at most ``largest`` in absolute value.

    Theorems ``boxes.growth``, ``box_disk.disk_reads``.
    """
    n, place = pencil.dynamic, "witness.growth"
    most = sum(map(absolute, pencil.tied), absolute(pencil.Z) + pencil.D)
    if ports:
        factors = [Fraction(1)] * most.ncols
        for k in ports:
            factors[k] = largest
        most = most @ diagonal_of(factors)
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


def box_stable_statement(claim: Json, box: Box) -> str:
    """Where all eigenvalues of all members lie."""
    return lie_inside(claim, box, box.members)


def lie_inside(claim: Json, box: System | FunctionSystem, members: str) -> str:
    """Where all eigenvalues of these members lie, also with one port multiplied by numbers."""
    limit, radii = claim["bound"], claim["gain_radii"]
    bound = int(box.time == "discrete") if limit is None else limit
    gains = ""
    if radii is not None:
        text = canonical_json(read_controller(radii, "claim.gain_radii"))
        programs = box.programs if isinstance(box, Box | FunctionLoop) else None
        near = radii_in_words(gain_pairs(programs, radii), "their radii")
        which = f"those of the controller {near}, the radii being those with {with_digest(text)}"
        gains = f", and for all controllers whose entries differ from {which}"
    disk = ""
    if "disk" in claim:
        port, size = claim["disk"]["at"].removesuffix("s"), claim["disk"]["margin"]
        disk = (
            f", also where any one {port} is multiplied by (1 + d/2)/(1 - d/2) for complex numbers "
            f"d with |d| <= {size} (disk margin {size} of each {port} by itself)"
        )
    return f"{members}{gains}{disk}, every eigenvalue of A has {inside(bound, box)}"


def gain_pairs(programs: Json, radii: Json) -> list[Pair]:
    """The radii of the gains of a controller; those of set-points are in no loop."""
    known, spread = (read_controller(value, "controller")["agents"] for value in (programs, radii))
    nominal, changes = list[Matrix](), list[Matrix]()
    for pair in zip(known, spread, strict=True):
        for label in MAPS:
            M, D = (_signals(agent.get(label, {})) for agent in pair)
            for signal in {**M, **D}:
                some = M.get(signal) or D[signal]
                zeros = Matrix.zeros(some.nrows, some.ncols)
                nominal.append(M.get(signal, zeros))
                changes.append(D.get(signal, zeros))
    return pairs_of(nominal, changes)


def _signals(program: Json) -> dict[tuple[str, str], Matrix]:
    """The matrices of a program that are in the loop, by the signal that each multiplies."""
    used = {("private", ""): program["private"]} if "private" in program else {}
    for key in ("outputs", "shared"):
        used |= {(key, name): M for name, M in program.get(key, {}).items()}
    return used


# Kind ``parametric_box_fixed``: no mode is fixed at any value; ``proofs/boxes.md``.


def check_parametric_box_fixed(claim: Json, witness: Json, plant: FunctionSystem) -> None:
    """Check the claim of the kind ``box_fixed`` for a box around the plants of each cell.

    Theorem ``boxes.regular_not_fixed``.
    """
    for box, part in boxes_of_cells(witness, plant):
        check_box_fixed(claim, part, box)


def parametric_box_fixed_statement(claim: Json, plant: FunctionSystem) -> str:
    """The words of the claim that no plant within the ranges has a fixed mode."""
    return f"{ranges_text(plant)}, there is {no_fixed_mode(claim['bound'], plant)}"


# Kind ``parametric_box_controllable``: channels control at all values; ``proofs/boxes.md``.


def check_parametric_box_controllable(claim: Json, witness: Json, plant: FunctionSystem) -> None:
    """Check the claim of the kind ``box_controllable`` for a box around the plants of each cell.

    Theorem ``joint_controllability.controllable_hautus``.
    """
    for box, part in boxes_of_cells(witness, plant):
        check_box_controllable(claim, part, box)


def parametric_box_controllable_statement(claim: Json, plant: FunctionSystem) -> str:
    """What the channels control."""
    return controls(claim, plant, ranges_text(plant))


# Kind ``parametric_box_stable``: loops are stable at all values; ``proofs/boxes.md``.


def check_parametric_box_stable(claim: Json, witness: Json, plant: FunctionSystem) -> None:
    """Check the claim of the kind ``box_stable``, without a disk, for a box around each cell.

    Theorems ``box_stable.tied_stable_continuous``, ``box_stable.tied_stable_discrete``.
    """
    fields(claim, "claim", "bound", "gain_radii")
    for box, part in boxes_of_cells(witness, plant):
        check_box_stable(claim, part, box)


def parametric_box_stable_statement(claim: Json, plant: FunctionSystem) -> str:
    """Where all eigenvalues lie."""
    return lie_inside(claim, plant, ranges_text(plant))
