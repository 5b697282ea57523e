"""What a verified claim says, in one line: the first thing that a person wants to know.

A summary says less than the statement of the same certificate, and nothing else: it leaves out
lists, discs, weights, and what the words mean.  A kind without a summary has a short statement.
"""

from collections.abc import Callable, Mapping
from fractions import Fraction

from .boxes import lie_inside
from .core.arithmetic import Polynomial
from .core.reading import Json
from .core.system import (
    PENCIL,
    System,
    channel_set,
    counted,
    denied,
    edge_set,
    polynomial_text,
    quoted,
)
from .discs import Box
from .loops import within as within_region
from .modes import inside, no_fixed_mode
from .parametric_system import FunctionSystem, ParametricSystem

LENGTH = 160
"""The most characters of a summary; what is longer is cut."""
CONTROL = "linear time-invariant decentralized control"
RADII = "for all plants within the radii"


def cut(text: str, length: int = LENGTH) -> str:
    """A text, cut where it is too long, with dots that say so."""
    return text if len(text) <= length else text[: length - 4] + " ..."


def roots_of(p: Polynomial) -> str:
    """The root of a linear polynomial, else its roots in words."""
    if len(p) == 2:
        return str(-Fraction(p[0]))
    text = polynomial_text(p)
    return f"the roots of {text}" if len(text) <= 60 else f"{len(p) - 1} roots"


def assignability(claim: Json, system: System) -> str:
    """How many eigenvalues gains move, component by component."""
    blocks = [block for block in claim["blocks"] if block["dimension"]]
    parts = [f"{block['dimension']} by {channel_set(block['channels'])}" for block in blocks]
    moved = f"{system.n - claim['fixed_degree']} of {counted(system.n, 'eigenvalue')}"
    return f"constant gains change at most {moved}" + (f": {', '.join(parts)}" if parts else "")


def box_controllable(claim: Json, box: Box, act: str = "control") -> str:
    """What the channels control, or observe."""
    bound = claim["bound"]
    where = "" if bound is None else f" of {inside(bound, box).replace('below', 'at least')}"
    return (
        f"{RADII}, the channels {channel_set(claim['channels'])} together {act} every mode{where}"
    )


def box_fixed(claim: Json, box: Box) -> str:
    """That no mode is fixed."""
    return f"{RADII}, there is {no_fixed_mode(claim['bound'], box)}"


def box_stable(claim: Json, box: Box) -> str:
    """Where all eigenvalues lie; with radii of gains, that there are some."""
    gains = "" if claim["gain_radii"] is None else ", and all controllers within theirs"
    if "disk" in claim:
        port, size = claim["disk"]["at"].removesuffix("s"), claim["disk"]["margin"]
        gains += f", each {port} by itself has a disk margin of {size}"
        claim = {key: value for key, value in claim.items() if key != "disk"}
    words = lie_inside({**claim, "gain_radii": None}, box, f"{RADII}{gains}")
    return words.replace("eigenvalue of A", "eigenvalue")


def closed_loop_spectrum(claim: Json, system: System) -> str:
    """The characteristic polynomial."""
    return f"the eigenvalues of A are {roots_of(claim['polynomial'])}"


def communication(claim: Json, system: System) -> str:
    """Which links suffice."""
    left = f"leaves {no_fixed_mode(claim['bound'], system)}"
    if not claim["feasible"]:
        return f"sharing {claim['share']} over none of the candidate links {left}"
    links = edge_set(claim["added"])
    return (
        f"sharing {claim['share']} along {links} {left}; no cheaper links do (cost {claim['cost']})"
    )


def complementary_subsystem(claim: Json, system: System) -> str:
    """Whether it is complete, and its remnant polynomial."""
    whose = channel_set(claim["subset"])
    remnant = polynomial_text(claim["remnant"])
    complete = f"{denied(claim['complete'])}complete"
    return f"the complementary subsystem of {whose} is {complete}, its remnant polynomial {remnant}"


def completeness(claim: Json, system: System) -> str:
    """Whether it is complete."""
    return f"it is {denied(claim['complete'])}complete"


def controllability(claim: Json, system: System, act: str = "control") -> str:
    """Which modes the channels control, or observe."""
    who = f"the channels {channel_set(claim['channels'])} together {act}"
    if claim["controllable"]:
        return f"{who} every mode"
    lost = roots_of(claim["uncontrollable_polynomial"])
    return f"{who} {claim['dimension']} of {system.n} dimensions, and not {lost}"


def controllability_indices(claim: Json, system: System, act: str = "control") -> str:
    """The indices."""
    listed = ", ".join(map(str, claim["indices"])) or "none"
    name = {"control": "controllability", "observe": "observability"}[act]
    return f"{name} indices {listed}; index {claim['index']}"


def cost_bound(claim: Json, system: System) -> str:
    """The bound."""
    whose = "linear time-invariant controller" + (" within the graph" if "graph" in claim else "")
    if "bandwidth" not in claim["weights"] and system.time == "continuous":
        whose = f"strictly proper {whose}"
    return f"every {whose} has at least the cost {claim['cost']}"


def deficiency(claim: Json, system: System) -> str:
    """The largest loss of rank."""
    return f"the rank of {PENCIL} is at least {system.n} - {claim['deficiency']}, which is attained"


def disk_margin(claim: Json, system: System) -> str:
    """The margin."""
    port, size = claim["at"].removesuffix("s"), claim["margin"]
    whose = f"all {port}s together have" if claim["together"] else f"each {port} by itself has"
    return f"the loop is stable, and {whose} a disk margin of {size}"


def distributed_observer(claim: Json, system: System) -> str:
    """That the spectrum separates."""
    feedback, error = (len(claim[key]) - 1 for key in ("feedback", "error"))
    limit = claim["bound"]
    where = "" if limit is None else f"; every root has {inside(limit, system)}"
    return f"feedback and errors separate, with {feedback} and {error} eigenvalues{where}"


def exceptional_gains(claim: Json, system: System) -> str:
    """Where the blocks lose rank."""
    p = claim["polynomial"]
    if len(p) == 1:
        return f"{claim['blocks']} blocks have rank {system.n} for every g"
    return f"{claim['blocks']} blocks have rank {system.n} but where g is {roots_of(p)}"


def fixed_spectrum(claim: Json, system: System) -> str:
    """The fixed modes, and what they leave."""
    p = claim["polynomial"]
    end = f"{denied(claim['stabilizable'])}stabilizable by {CONTROL}"
    if len(p) == 1:
        return f"no mode is fixed; {end}"
    return (
        f"{'the mode ' * (len(p) == 2)}{roots_of(p)} {'is' if len(p) == 2 else 'are'} fixed; {end}"
    )


def loop_cost(claim: Json, system: System) -> str:
    """The cost."""
    return f"the loop is stable, at a cost of at most {claim['cost']}"


def parametric_fixed_spectrum(claim: Json, system: ParametricSystem) -> str:
    """Whether modes are fixed for every value, and at how many others."""
    degree = sum(len(p) - 1 for p in claim["generic"])
    whole = f"{counted(degree, 'mode')}, with multiplicity," if degree else "no mode"
    more = len(claim["exceptional"])
    rest = f"; other ones at {counted(more, 'value')} or conjugates" if more else ""
    return f"{whole} fixed for every value of {system.parameter}{rest}"


def saturation(claim: Json, system: System) -> str:
    """From where solutions tend to each other, or to 0."""
    if "region" not in claim:
        return (
            "with inputs cut off at their limits, any two solutions with the same set-points and "
            "disturbances approach each other"
        )
    radius = claim["region"]["radius"]
    return (
        f"with inputs cut off at their limits, the undisturbed loop tends to 0 from all plant "
        f"states of norm at most {radius}"
    )


def setpoint(claim: Json, system: System) -> str:
    """Whether integrators can hold the outputs."""
    if claim["solvable"]:
        return "integrators of all outputs add no uncontrollable mode"
    return "no stable linear time-invariant loop holds all constant set-points"


def shared_dimensions(claim: Json, system: System) -> str:
    """Which dimensions suffice."""
    goal = no_fixed_mode(claim["bound"], system)
    goal += " and connect the agents" if claim["free_assignability"] else ""
    if not claim["feasible"]:
        return f"no shared dimensions within the bounds leave {goal}"
    pairs = zip(map(quoted, system.names), claim["dimensions"], strict=True)
    listed = ", ".join(f"{name}: {size}" for name, size in pairs)
    least = claim.get("at_least", claim["cost"])
    within = "" if claim["upper"] == [None] * system.m else " within the bounds"
    less = f"no cost below {least}{within} does" if Fraction(least) else "nothing costs less"
    return f"sharing {{{listed}}} leaves {goal}, at the cost {claim['cost']}; {less}"


def sharing_gap(claim: Json, system: System) -> str:
    """Both numbers."""
    pairs = ((claim[key], claim[f"{key}_at_most"]) for key in ("relays", "boundary"))
    relays, boundary = (str(a) if a == b else f"{a} to {b}" for a, b in pairs)
    return f"the neighbor graph has {relays} relays, and boundaries of {boundary} agents"


def single_channel_gains(claim: Json, system: System) -> str:
    """Whether one channel is enough under some gains."""
    act = {"controllable": "control", "observable": "observe", "both": "control and observe"}
    which = f"each channel of {channel_set(claim['channels'])} {act[claim['property']]} every mode"
    return f"{'some' if claim['exists'] else 'no'} constant gains let {which}"


def stability(claim: Json, system: System) -> str:
    """Where all eigenvalues lie, or that they do not."""
    return f"{denied(claim['stable'])}every eigenvalue has {within_region(claim, system)}"


def step_peaks(claim: Json, system: System) -> str:
    """The largest bound of inputs and of outputs."""
    step = {"inputs": "input", "outputs": "output", "setpoints": "set-point"}[claim["at"]]
    u, y = (
        max((Fraction(x) for row in claim[key] for x in row), default=Fraction(0))
        for key in ("inputs", "outputs")
    )
    return f"after a step of 1 at any one {step}, inputs stay within {u} and outputs within {y}"


def structural_fixed_modes(claim: Json, system: System) -> str:
    """What is fixed whatever the numbers are."""
    U, z = len(claim["without_feedback"]), claim["at_zero"]
    if not U + z:
        return "no mode is fixed for all numbers at the places of its entries"
    own = [f"the modes of {counted(U, 'state')} without feedback"] if U else []
    zero = [f"{counted(z, 'mode')} at 0"] if z else []
    return (
        f"{' and '.join(own + zero)}: fixed for all numbers at the places of its entries; here the "
        f"roots of {polynomial_text(claim['polynomial'])}"
    )


def transfer_graph(claim: Json, system: System) -> str:
    """Whether it is strongly connected."""
    if claim["strongly_connected"]:
        return "the transfer graph is strongly connected"
    parts = ", ".join(map(channel_set, claim["components"])) or "none"
    return f"the transfer graph is not strongly connected; its strong components are {parts}"


SUMMARIES: Mapping[str, Callable[..., str]] = {
    each.__name__: each
    for each in (
        assignability,
        box_controllable,
        box_fixed,
        box_stable,
        closed_loop_spectrum,
        communication,
        complementary_subsystem,
        completeness,
        controllability,
        controllability_indices,
        cost_bound,
        deficiency,
        disk_margin,
        distributed_observer,
        exceptional_gains,
        fixed_spectrum,
        loop_cost,
        parametric_fixed_spectrum,
        saturation,
        setpoint,
        shared_dimensions,
        sharing_gap,
        single_channel_gains,
        stability,
        step_peaks,
        structural_fixed_modes,
        transfer_graph,
    )
}
"""The summary of each kind whose statement is long."""


OF_DUAL: Mapping[str, Callable[..., str]] = {
    "box_controllable": box_controllable,
    "controllability": controllability,
    "controllability_indices": controllability_indices,
}
"""The kinds whose claims about a dual system say what channels of the system observe."""


def _named(step: dict[str, Json]) -> str:
    """A construction in a word or two, samples with their period."""
    name = step["construction"].replace("_", " ")
    return f"{name} every {step['step']}" if step["construction"] == "sampled" else name


def summary(document: dict[str, Json], subject: System | FunctionSystem, statement: str) -> str:
    """What a verified certificate says, in one line, after the constructions of its subject."""
    kind, claim = document["kind"], document["claim"]
    steps = [_named(step) for step in document["subject"]]
    if kind in OF_DUAL and steps[-1:] == ["dual"]:
        text = OF_DUAL[kind](claim, subject, "observe")
        steps.pop()
    else:
        text = SUMMARIES[kind](claim, subject) if kind in SUMMARIES else statement
    return cut(f"{', '.join(steps)}: {text}" if steps else text)
