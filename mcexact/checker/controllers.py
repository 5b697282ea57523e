"""Controllers in canonical form, from a certificate or a controller file, and their digest.

Like plants, they are read from certificates and from files by the same functions: a file may give
numbers as decimals, a certificate must have the canonical form, of which the digest is taken.
Limits of inputs and anti-windup gains stand beside the maps, and are read from files alone.
"""

from __future__ import annotations

from .core import reading
from .core.arithmetic import Matrix
from .core.budget import current, limited
from .core.reading import Json, Limits, fields, integer, items, malformed, shown, string
from .core.system import System, canonical_json, digest_of, parse_file, read_limits, read_matrix

MAPS = ("shared_update", "private_update", "input")
USED = ("outputs", "shared", "private", "reference")
FORMAT = "mcexact-controller/1"
PERIODIC_FORMAT = "mcexact-periodic-controller/1"


def read_controller(
    value: Json, place: str, system: System | None = None, limits: Limits | None = None
) -> dict[str, Json]:
    """The canonical object of a controller, its matrices read.

    What is absent or empty is left out, and so are matrices of zeros and a hold of no steps: who
    does not act on a signal does not use it.  Without a system the numbers of inputs and outputs
    are not known; ``limits`` are those of a file.
    """
    time, listed = fields(value, place, "time", "agents")
    keys = ("name", "shared", "private", *MAPS)
    optional = ("hold", *(SATURATION if limits is not None else ()))
    agents = [fields(agent, place, *keys, optional=optional) for agent in items(listed, place)]
    if not agents:
        malformed(place, "expected at least one agent")
    known = reading.own_names([agent[0] for agent in agents], [place] * len(agents))
    ports = system if system and system.names == known else None
    q = [C.nrows for C in ports.C] if ports else [None] * len(known)
    p = [B.ncols for B in ports.B] if ports else [None] * len(known)
    x, z = ([integer(agent[k], place) for agent in agents] for k in (1, 2))
    programs: list[dict[str, Json]] = []
    for i, (_, _, _, shared_update, private_update, control, hold, *_) in enumerate(agents):
        steps = {name: integer(d, place) for name, _, d in reading.by_name(hold, place, known)}
        program: dict[str, Json] = {"hold": {name: d for name, d in steps.items() if d}}
        updates = (shared_update, x[i]), (private_update, z[i]), (control, p[i])
        for label, (parts, nrows) in zip(MAPS, updates, strict=True):
            where = f"{place}.{label}"
            *by_agent, private, reference = fields(parts, where, optional=USED)
            maps: dict[str, Json] = {}
            read: list[Matrix] = []
            for key, entries, widths in zip(USED, by_agent, (q, x), strict=False):
                used = [
                    (name, read_matrix(M, where, nrows, widths[j], limits))
                    for name, j, M in reading.by_name(entries, where, known)
                ]
                read += [M for _, M in used]
                maps[key] = {name: M for name, M in used if not M.is_zero()}
            for key, entry, width in (("private", private, z[i]), ("reference", reference, q[i])):
                if entry is not None:
                    read.append(read_matrix(entry, where, nrows, width, limits))
                    maps[key] = None if read[-1].is_zero() else read[-1]
            if len({M.nrows for M in read}) > 1:
                malformed(where, "expected matrices of one number of rows")
            program[label] = {key: part for key, part in maps.items() if part}
        kept = {key: part for key, part in program.items() if part}
        programs.append({"name": known[i], "shared": x[i], "private": z[i], **kept})
    return {"time": string(time, place, "continuous", "discrete"), "agents": programs}


SATURATION = ("limits", "back_calculation")
"""The keys of a controller file that are no part of the linear program."""
Saturation = tuple[tuple[Json, Matrix | None], ...]
"""For each agent the limits of its inputs, and its anti-windup gains, each None without any."""


def _read_saturation(agents: list[Json], place: str, limits: Limits) -> Saturation:
    """The limits and anti-windup gains of agents that `read_controller` has read."""
    result = list[tuple[Json, Matrix | None]]()
    for agent in agents:
        listed, gains = (agent.get(key) for key in SATURATION)
        rows = [M for key in USED[:2] for M in agent["input"].get(key, {}).values()]
        rows += [M for key in USED[2:] if (M := agent["input"].get(key)) is not None]
        p = read_matrix(rows[0], place, None, None, limits).nrows if rows else None
        if listed is not None:
            p = len(items(listed, place, p))
            listed = read_limits(listed, place, p, limits)
        L = None
        if gains is not None:
            L = read_matrix(gains, place, agent["shared"] + agent["private"], p, limits)
        result.append((listed, L))
    return tuple(result)


def read_controller_file(data: bytes, limits: Limits) -> tuple[str, str, Saturation]:
    """The digest of the controller in a file, that of its plant or "", and its saturation."""
    with limited(current(limits.work), len(data)):
        document = parse_file(data, limits)
        if isinstance(document, dict) and document.get("format") == PERIODIC_FORMAT:
            return _read_periodic_file(document, limits)
        keys = ("format", "system", "time", "agents")
        version, plant, *parts = fields(document, "controller", *keys)
        if version != FORMAT:
            malformed("format", f"expected {FORMAT!r}, found {shown(version)}")
        loop = dict(zip(("time", "agents"), parts, strict=True))
        controller = read_controller(loop, "controller", limits=limits)
        saturation = _read_saturation(parts[1], "controller", limits)
        return digest_of(canonical_json(controller)), string(plant, "system"), saturation


def _read_periodic_file(document: Json, limits: Limits) -> tuple[str, str, Saturation]:
    """The same of the file of a periodic controller, whose phases are controllers of one plant."""
    _, plant, time, listed = fields(document, "controller", "format", "system", "time", "phases")
    phases = []
    for t, phase in enumerate(items(listed, "controller")):
        (agents,) = fields(phase, f"phases[{t}]", "agents")
        own = {"time": time, "agents": agents}
        phases.append(read_controller(own, f"phases[{t}]", limits=limits))
    return digest_of(canonical_json({"phases": phases})), string(plant, "system"), ()
