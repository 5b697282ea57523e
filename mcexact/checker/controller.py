"""Controllers in canonical form, from a certificate or a controller file, and their digest."""

from . import reading
from .arithmetic import Matrix
from .budget import current, limited
from .reading import Json, Limits, fields, integer, items, malformed, shown, string
from .statement import canonical_json, digest_of
from .system import System, parse_file
from .system_matrices import read_matrix

MAPS = ("shared_update", "private_update", "input")
USED = ("outputs", "shared", "private", "reference")
FORMAT = "mcexact-controller/1"


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
    agents = [fields(agent, place, *keys, optional=("hold",)) for agent in items(listed, place)]
    if not agents:
        malformed(place, "expected at least one agent")
    known = reading.own_names([agent[0] for agent in agents], [place] * len(agents))
    ports = system if system and system.names == known else None
    q = [C.nrows for C in ports.C] if ports else [None] * len(known)
    p = [B.ncols for B in ports.B] if ports else [None] * len(known)
    x, z = ([integer(agent[k], place) for agent in agents] for k in (1, 2))
    programs: list[dict[str, Json]] = []
    for i, (*_, shared_update, private_update, control, hold) in enumerate(agents):
        steps = {name: integer(d, place) for name, _, d in reading.by_name(hold, place, known)}
        program: dict[str, Json] = {"hold": {name: d for name, d in steps.items() if d}}
        given = (shared_update, x[i]), (private_update, z[i]), (control, p[i])
        for label, (parts, nrows) in zip(MAPS, given, strict=True):
            where = f"{place}.{label}"
            *by_agent, private, reference = fields(parts, where, optional=USED)
            found: dict[str, Json] = {}
            read: list[Matrix] = []
            for key, entries, widths in zip(USED, by_agent, (q, x), strict=False):
                used = [
                    (name, read_matrix(M, where, nrows, widths[j], limits))
                    for name, j, M in reading.by_name(entries, where, known)
                ]
                read += [M for _, M in used]
                found[key] = {name: M for name, M in used if not M.is_zero()}
            for key, entry, width in (("private", private, z[i]), ("reference", reference, q[i])):
                if entry is not None:
                    read.append(read_matrix(entry, where, nrows, width, limits))
                    found[key] = None if read[-1].is_zero() else read[-1]
            if len({M.nrows for M in read}) > 1:
                malformed(where, "expected matrices of one number of rows")
            program[label] = {key: part for key, part in found.items() if part}
        kept = {key: part for key, part in program.items() if part}
        programs.append({"name": known[i], "shared": x[i], "private": z[i], **kept})
    return {"time": string(time, place, "continuous", "discrete"), "agents": programs}


def read_controller_file(data: bytes, limits: Limits) -> tuple[str, str]:
    """The digest of the controller in a file, and that of its plant, empty if it names none."""
    with limited(current(limits.work), len(data)):
        document = parse_file(data, limits)
        keys = ("format", "system", "time", "agents")
        version, plant, *parts = fields(document, "controller", *keys)
        if version != FORMAT:
            malformed("format", f"expected {FORMAT!r}, found {shown(version)}")
        given = dict(zip(("time", "agents"), parts, strict=True))
        controller = read_controller(given, "controller", limits=limits)
        return digest_of(canonical_json(controller)), string(plant, "system")
