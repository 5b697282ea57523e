"""The pencil of a closed loop with its outputs and inputs as signals, for all members of a box."""

from .arithmetic import Matrix, stack
from .boxes import Box
from .closed_loop import (
    Signal,
    Terms,
    mapped,
    programs_of,
    rows_of_states,
    rows_that_read,
    signals_of,
)
from .controller import MAPS, read_controller
from .reading import Json, malformed, require
from .regular_discs import Pencil
from .sparse import entries_of
from .system import System

PLACE = "claim.gain_radii"


def loop_pencil(box: Box, gain_radii: Json) -> Pencil:
    """λE − Z in the order of the loop's state, then of all y_i, then of all u_i.

    Z is [A, 0, 0, B; 0, L_z, L_y, 0; C, 0, −I, 0; 0, K_z, K_y, −I]: the last two blocks of columns
    are unit lower triangular in the last rows, up to the sign, for every member.

    Open: see ``proofs/OPEN.md``.
    """
    if box.plant is None:
        require(gain_radii is None, "claim", PLACE, "expected null without a controller")
        return Pencil(box.A, box.radii.A, box.n, [each.A for each in box.tied])
    plant, radii = box.plant, box.plant.radii
    agents = read_controller(box.programs, "subject", plant)["agents"]
    programs = programs_of(plant, agents, "subject")
    order = signals_of(plant, agents, programs)
    still: list[list[Terms]] = [[[] for _ in MAPS] for _ in agents]
    moved = still if gain_radii is None else _read_radii(gain_radii, plant, agents)
    Z, D = _pencil(plant, order, programs, 1), _pencil(radii, order, moved, 0)
    return Pencil(Z, D, box.n, [_pencil(each, order, still, 0) for each in plant.tied])


def _read_radii(value: Json, plant: System, agents: list[Json]) -> list[list[Terms]]:
    """The radii of the programs' matrices, for signals that are in the loop."""
    given = read_controller(value, PLACE, plant)
    known = [{**agent, **dict.fromkeys(MAPS)} for agent in agents]
    fits = given["time"] == plant.time
    fits &= [{**agent, **dict.fromkeys(MAPS)} for agent in given["agents"]] == known
    require(fits, "claim", PLACE, "expected agents of the same sizes, which hold as long")
    found = programs_of(plant, given["agents"], PLACE)
    for M in (M for maps in found for terms in maps for _, M in terms):
        if any(entry < 0 for _, _, entry in entries_of(M)):
            malformed(PLACE, "expected radii from 0 on")
    return found


def _pencil(
    system: System, order: list[tuple[Signal, int]], programs: list[list[Terms]], one: int
) -> Matrix:
    """The matrix Z, where identities are ``one`` times themselves."""
    outputs = [(("y", j, 0), C_j.nrows) for j, C_j in enumerate(system.C)]
    inputs = [(("u", j, 0), B_j.ncols) for j, B_j in enumerate(system.B)]
    reads = rows_that_read([*order, *outputs, *inputs])
    x, m = reads["X", 0, 0], range(system.m)
    used = {signal for maps in programs for terms in maps for signal, _ in terms}
    require(used <= reads.keys(), "claim", PLACE, "expected radii for signals of the loop alone")
    rows = rows_of_states(system, programs, order, reads, [reads["u", j, 0] for j in m], one)
    rows += [system.C[j] @ x - reads["y", j, 0].times(one) for j in m]
    for j, (signal, width) in enumerate(inputs):
        rows.append(mapped(programs[j][2], reads, width, x.ncols) - reads[signal].times(one))
    return stack(rows, x.ncols)
