"""The plant, read from a certificate or from a system file, and its digest."""

from dataclasses import dataclass, field, replace

from . import budget, reading
from .arithmetic import Matrix
from .reading import Json, Limits, fields, integer, items, malformed, printable, shown, string
from .system_matrices import form_of, number, read_matrix
from .uncertainty import as_typed, radii_form


@dataclass(frozen=True)
class System:
    """x' = Ax + Σ B_i u_i, y_i = C_i x (or x(t+1) = …), with the neighbor graph.

    ``neighbors[i]`` is N_i in the order of the channels, with i in it; None means that there is no
    graph; ``delays[i, j]`` is d_ij where it is not 0.  ``words`` name the system in
    statements; in a closed loop ``blocks`` are the sizes of x, x_1, z_1, x_2, z_2, …,
    ``controller`` is the digest of the controller, and ``ports`` say whose the states are and which
    channels it closes.  ``uncertainty`` are the radii of all entries in
    canonical form; None means that all are certain.
    """

    time: str
    names: list[str]
    A: Matrix
    B: list[Matrix]
    C: list[Matrix]
    neighbors: list[list[int]] | None = None
    delays: dict[tuple[int, int], int] = field(default_factory=dict)
    words: str = "the plant"
    blocks: tuple[int, ...] = ()
    controller: str = ""
    ports: str = ""
    uncertainty: Json = None

    @property
    def n(self) -> int:
        """The number of states."""
        return self.A.nrows

    @property
    def m(self) -> int:
        """The number of channels."""
        return len(self.names)

    def place_of(self, name: Json, place: str) -> int:
        """The position of one named channel."""
        return reading.names([name], place, self.names)[0]


def read_system(value: Json, limits: Limits | None = None, typed: Json = None) -> System:
    """Read a system object by the grammar of system files; without limits, of a certificate.

    ``typed`` is the same document with its numbers as texts, if there is one.
    """
    extra = () if limits is None else ("format", "name", "source", "sample_time", "D")
    keys = ("time", "A", "channels")
    optional = ("neighbors", "delays", "uncertainty", *extra)
    time, A_rows, listed, heard, waits, doubt, *more = fields(
        value, "system", *keys, optional=optional
    )
    A = read_matrix(A_rows, "A", None, None, limits)
    if A.nrows != A.ncols or not items(listed, "channels"):
        malformed("system", "expected a square A and at least one channel")
    B, C, names = [], [], []
    budget.spend(4 * len(listed) ** 2)  # names are compared, and delays looked up, for every pair
    for k, channel in enumerate(budget.counted(listed)):
        where = f"channels[{k}]"
        B_rows, C_rows, name, D = fields(channel, where, "B", "C", optional=("name", "D"))
        B.append(read_matrix(B_rows, f"{where}.B", A.nrows, None, limits))
        C.append(read_matrix(C_rows, f"{where}.C", None, A.nrows, limits))
        names.append(str(k + 1) if name is None else name)
        _require_no_feedthrough(D, f"{where}.D", limits)
    known = reading.own_names(names, [f"channels[{k}].name" for k in range(len(names))])
    radii = None if doubt is None else radii_form(doubt, known, [A, *B, *C], limits, typed)
    plant = System(string(time, "time", "continuous", "discrete"), known, A, B, C)
    plant = replace(plant, uncertainty=radii)
    if limits is not None:
        _check_unused(plant, more[1:], limits)
    return plant if heard is None and waits is None else _with_graph(plant, heard, waits)


def _check_unused(plant: System, given: list[Json], limits: Limits) -> None:
    """Read the parts of a system file on which no claim depends: they are not in the digest."""
    name, source, sample_time, D = given
    for key, text in (("name", name), ("source", source)):
        printable("" if text is None else text, key, 10_000, allowed="\n\t")
    period = None if sample_time is None else number(sample_time, "sample_time", limits)
    if period is not None and (period <= 0 or plant.time != "discrete"):
        malformed("sample_time", "expected a number above 0, in discrete time only")
    _require_no_feedthrough(D, "D", limits)


def _require_no_feedthrough(D: Json, place: str, limits: Limits | None) -> None:
    """Refuse a D that is not zero, of any shape."""
    if D is not None and not read_matrix(D, place, None, None, limits).is_zero():
        malformed(place, "expected no feedthrough: outputs are y_i = C_i x")


def _with_graph(plant: System, heard: Json, waits: Json) -> System:
    known = tuple(plant.names)
    sets = []
    for i, row in enumerate(fields(heard, "neighbors", optional=known)):
        listed = [] if row is None else items(row, "neighbors")
        found = [plant.place_of(name, "neighbors") for name in listed]
        if len(set(found)) < len(found):
            malformed("neighbors", f"{shown(known[i])} lists a neighbor twice")
        sets.append(sorted({i, *found}))
    delays = {}
    for i, row in enumerate(fields({} if waits is None else waits, "delays", optional=known)):
        for _, j, steps in reading.by_name(row, "delays", known):
            if (integer(steps, "delays") and i == j) or j not in sets[i]:
                malformed("delays", f"{shown(known[i])} receives nothing from {shown(known[j])}")
            if steps:
                delays[i, j] = steps
    return replace(plant, neighbors=sets, delays=delays)


def canonical(system: System) -> dict[str, Json]:
    """The canonical object of this plant in a certificate."""
    known, channels = system.names, zip(system.names, system.B, system.C, strict=True)
    result: dict[str, Json] = {"time": system.time, "A": form_of(system.A)}
    result["channels"] = [
        {"name": name, "B": form_of(B), "C": form_of(C)} for name, B, C in channels
    ]
    if system.neighbors is not None:
        sets = enumerate(system.neighbors)
        result["neighbors"] = {known[i]: [known[j] for j in N_i if j != i] for i, N_i in sets}
    for (i, j), steps in system.delays.items():
        result.setdefault("delays", {}).setdefault(known[i], {})[known[j]] = steps
    if system.uncertainty is not None:
        result["uncertainty"] = system.uncertainty
    return result


def read_plant(value: Json) -> System:
    """The system object of a certificate, which must be canonical."""
    system = read_system(value)
    if canonical(system) != value:
        malformed("system", "expected the canonical form: lowest terms, neighbors in order")
    return system


def parse_file(data: bytes, limits: Limits) -> Json:
    """The document of a system file or a controller file, its numbers exactly as typed."""
    return reading.parse(data, limits, lambda text: number(text, f"number {text[:24]}", limits))


def read_system_file(data: bytes, limits: Limits) -> System:
    """The system of a system file, numbers as typed."""
    with budget.limited(budget.current(limits.work), len(data)):
        document = parse_file(data, limits)
        if not isinstance(document, dict) or document.get("format") != "mcexact-system/1":
            malformed("format", 'expected a system file, "format": "mcexact-system/1"')
        return read_system(document, limits, as_typed(data, document, limits))
