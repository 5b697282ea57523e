"""The statement of a certificate, and its digest, from the templates of ``FORMAT.md``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from flint import fmpq, fmpq_mat, fmpq_poly

from .constructions import chosen, is_ranged, output_gains, subject_of
from .controllers import MAPS, read_agents
from .reading import is_sparse, matrix, rational
from .sentences import SENTENCES, SHARING
from .systems import System, read_plant
from .words import (
    by_channel,
    channels,
    digested,
    edges,
    json_text,
    name,
    number,
    polynomial_text,
    sha256,
)


def statement(document: Mapping[str, Any]) -> str:
    """The line of a true certificate."""
    system = subject_of(document)
    words = system_words(document)
    claim = document["claim"]
    if claim.get("gain_radii") is not None:
        inner = subject_of(document, len(document["subject"]) - 1)
        text = digested(_controller(claim["gain_radii"], inner))
        pairs = gain_pairs(document["subject"][-1]["controller"], claim["gain_radii"], inner)
        claim = {**claim, "gain_radii": (near(pairs, "their radii"), text)}
    given: tuple[Any, ...] = (claim, system)
    if is_ranged(document):
        given = (*given, ranges(document))
    elif document["kind"].startswith("box_"):
        given = (*given, members(document))
    sentence = SENTENCES[document["kind"]](*given)
    return f"For {words} ({_sizes(document, system)}): {sentence}"


def members(document: Mapping[str, Any]) -> str:
    """All plants of the box."""
    plant = read_plant(document["system"])
    sampled = any(step["construction"] == "sampled" for step in document["subject"])
    behind = ", sampled without rounding" if sampled else ""
    if plant.radii is None:
        return f"for this plant alone, as none of its entries has a radius{behind}"
    certain = {key: part for key, part in document["system"].items() if key != "uncertainty"}
    pairs = []
    for M, D in zip((plant.A, *plant.B, *plant.C), _flat(plant.radii), strict=True):
        pairs += zip(D.entries(), M.entries(), strict=True)
    how = near(pairs, f"the radii of the plant {plant_digest(document)}")
    values = plant_digest({**document, "system": certain})
    return f"for all plants whose entries differ from those of the plant {values} {how}{behind}"


def _flat(radii: Any) -> list[Any]:
    A, B, C = radii
    return [A, *B, *C]


def near(pairs: Sequence[tuple[fmpq, fmpq]], whose: str) -> str:
    """How far entries may be, from pairs of a radius and an entry."""
    wide = [(r, abs(v)) for r, v in pairs if r != 0]
    if not wide:
        return f"by at most {whose} (no entry has one)"
    zero = any(v == 0 for _, v in wide)
    largest = max(r for r, _ in wide)
    if not zero:
        ratio = max(r / v for r, v in wide)
        if all(r == ratio * abs(v) for r, v in pairs):
            return f"by at most {number(ratio)} of the absolute values of the latter"
    have = "1 entry has one" if len(wide) == 1 else f"{len(wide)} entries have one"
    more = "" if zero else f" and none above {number(ratio)} of the absolute value of its entry"
    return f"by at most {whose} ({have}, none above {number(largest)}{more})"


def gain_pairs(programs: Any, radii: Any, system: System) -> list[tuple[fmpq, fmpq]]:
    """The radii of the gains that are in the loop, with the gains."""
    pairs = []
    for agent, spread in zip(
        *(read_agents(system, each) for each in (programs, radii)), strict=True
    ):
        for label in MAPS:
            gains, found = agent.maps[label], spread.maps[label]
            for signal in {*gains, *found}:
                if signal[0] != "reference":
                    M, D = gains.get(signal), found.get(signal)
                    some = M if M is not None else D
                    zeros = fmpq_mat(some.nrows(), some.ncols())
                    pairs += zip((D or zeros).entries(), (M or zeros).entries(), strict=True)
    return pairs


def ranges(document: Mapping[str, Any]) -> str:
    """All values within the ranges of parameters."""
    known = sorted(document["system"]["parameters"].items())
    told = (
        f"of the parameter {t} from {ends['range'][0]} to {ends['range'][1]}" for t, ends in known
    )
    return f"for all real values {' and '.join(told)}"


def plant_digest(document: Mapping[str, Any]) -> str:
    """The digest of the plant."""
    if "parameters" in document["system"]:
        return sha256(json_text(document["system"]))
    plant = read_plant(document["system"])
    table: dict[str, Any] = {"time": plant.time, "A": _table(plant.A), "channels": []}
    for label, B, C in zip(plant.names, plant.B, plant.C, strict=True):
        table["channels"].append({"name": label, "B": _table(B), "C": _table(C)})
    if plant.D is not None:
        table["D"] = _table(plant.D)
    if plant.neighborhoods is not None:
        table["neighbors"] = {
            plant.names[i]: [plant.names[j] for j in N if j != i]
            for i, N in enumerate(plant.neighborhoods)
        }
    if plant.delays:
        delays: dict[str, dict[str, int]] = {}
        for (i, j), steps in plant.delays.items():
            delays.setdefault(plant.names[i], {})[plant.names[j]] = steps
        table["delays"] = delays
    if plant.radii is not None:
        A, *ports = plant.radii
        forms: dict[str, Any] = {"A": _listed(A)}
        for key, matrices in zip("BC", ports, strict=True):
            pairs = zip(plant.names, map(_listed, matrices), strict=True)
            forms[key] = {label: form for label, form in pairs if form}
        table["uncertainty"] = {"absolute": {key: form for key, form in forms.items() if form}}
    return sha256(json_text(table))


def _listed(M: Any) -> Any:
    """The radii of a matrix by their positions; nothing if there is none."""
    found = [[i, j, v] for i, row in enumerate(M.tolist()) for j, v in enumerate(row) if v != 0]
    return {"shape": [M.nrows(), M.ncols()], "entries": found} if found else None


def _table(M: Any) -> Any:
    rows = M.tolist()
    found = [[i, j, v] for i, row in enumerate(rows) for j, v in enumerate(row) if v != 0]
    if is_sparse(M.nrows(), M.ncols(), len(found)) or (M.ncols() and not M.nrows()):
        return {"shape": [M.nrows(), M.ncols()], "entries": found}
    return M


def _sizes(document: Mapping[str, Any], system: System) -> str:
    states = "1 state" if system.n == 1 else f"{system.n} states"
    ports = f"channels {channels(system.names)}" if system.m else "no channels"
    steps = document["subject"]
    if steps and steps[-1]["construction"] in ("closed_loop", "periodic_loop"):
        inner = subject_of(document, len(steps) - 1)
        ports = (
            f"{inner.n} of the controlled system and {system.n - inner.n} added by the controller "
            f"of the channels {channels(inner.names)}"
        )
    return f"{states}, {ports}, {system.time} time"


def system_words(document: Mapping[str, Any]) -> str:
    """The plant and its constructions."""
    text, before = f"the plant {plant_digest(document)}", False
    if "uncertainty" in document["system"] and not document["kind"].startswith("box_"):
        text += " at its nominal values"
    for k, step in enumerate(document["subject"]):
        words = _words(step, subject_of(document, k))
        if words.endswith("of: "):
            text, before = words + text, True
        else:
            text, before = f"{f'({text})' if before else text} {words}", False
    return text


def _words(step: Mapping[str, Any], system: System) -> str:
    names = system.names
    kind = step["construction"]
    if kind == "feedback":
        gains = dict(zip(names, output_gains(system, step["gains"]), strict=True))
        return f"under the decentralized gains F with {digested(gains)}"
    if kind == "error":
        shapes = zip(names, step["gains"], system.B, strict=True)
        gains = {label: matrix(F, B.ncols(), system.n) for label, F, B in shapes}
        return f"the open-loop error system under the state feedback F with {digested(gains)} of: "
    if kind in ("regulated", "servo"):
        picked = dict(zip(names, chosen(system, step), strict=True))
        which = f"the combinations S of its outputs with {digested(picked)}"
        return f"with {which}" if kind == "regulated" else f"with integrators of {which}"
    if kind == "internal_model":
        picked = dict(zip(names, chosen(system, step), strict=True))
        p = polynomial_text(step["polynomial"])
        what = f"signals of {p} for the combinations S of its outputs"
        return f"with models of the {what} with {digested(picked)}"
    if kind == "full_output":
        return f"with the whole state measured by channel {name(step['channel'])}"
    if kind == "arcs":
        order = {label: k for k, label in enumerate(names)}
        added = sorted(step["added"], key=lambda e: (order[e[0]], order[e[1]]))
        return f"with the links {edges(added)} added to its neighbor graph"
    if kind == "merged":
        return f"with its channels merged into {', '.join(map(channels, step['parts']))}"
    if kind == "modulo":
        W = matrix(step["annihilator"], len(step["pivots"]), system.n)
        which = digested({"W": W, "pivots": step["pivots"]})
        p = polynomial_text(step["polynomial"])
        part = f"an {step['part']} part with the characteristic polynomial {p}"
        return f"modulo {part} and W with {which}"
    if kind == "failed":
        parts = {part: lost for part, lost in step.items() if lost and part != "construction"}
        return f"after the failures {json_text(parts)}"
    if kind == "restricted":
        return f"with the channels {channels(step['channels'])} alone"
    if kind == "line":
        values = {
            label: fmpq_poly([rational(step[key][label]) for key in ("point", "direction")])
            for label in sorted(step["point"])
        }
        told = [f"{a} = {polynomial_text(p, step['parameter'])}" for a, p in values.items()]
        return f"along the line {', '.join(told)}"
    if kind == "closed_loop":
        shown = digested(_controller(step["controller"], system))
        return f"the closed loop with the controller with {shown} of: "
    if kind == "periodic_loop":
        phases = [_controller(phase, system) for phase in step["phases"]]
        steps = f"{len(phases)} step{'s' * (len(phases) != 1)}"
        shown = digested({"phases": phases})
        return f"the loop over {steps} with the periodic controller with {shown} of: "
    if kind == "sampled":
        late = step["late"]
        delay = f" and {late} step{'s' * (late != 1)} late" if late else ""
        k = step["decimals"]
        digits = f"{k} decimal{'s' * (k != 1)}"
        return f"sampled every {rational(step['step'])} with its inputs held{delay}, to {digits}"
    if kind == "slow":
        return f"the system in windows of {step['window']} steps of: "
    if kind in ("extended", "lifted", "held"):
        how = {
            "extended": "without delays sharing",
            "lifted": "with delays, lifted, sharing",
            "held": "with delays, held, sharing",
        }[kind]
        sizes = by_channel(names, step["dimensions"])
        shared = SHARING[step.get("share", "states")]
        return f"the extended system {how} {shared} of dimensions {sizes} of: "
    return {
        "augmented_outputs": "with the outputs of neighbors measured by each agent",
        "dual": "the dual of: ",
        "input_filters": (
            "with its inputs as states, which their agents "
            f"{'set one step late' if system.time == 'discrete' else 'set by their derivatives'} "
            "and measure"
        ),
        "integrators": "with integrators of its outputs",
    }[kind]


def _controller(value: Any, system: System) -> Any:
    """The controller without what is empty and without holds of 0."""
    agents = []
    for agent, label in zip(read_agents(system, value), system.names, strict=True):
        shown: dict[str, Any] = {
            "name": label,
            "shared": agent.shared,
            "private": agent.private,
        }
        hold = {system.names[i]: steps for i, steps in agent.hold.items() if steps}
        if hold:
            shown["hold"] = hold
        for part in MAPS:
            made: dict[str, Any] = {}
            for (kind, j), M in agent.maps[part].items():
                if kind in ("private", "reference"):
                    made[kind] = M
                else:
                    made.setdefault(kind, {})[system.names[j]] = M
            if made:
                shown[part] = made
        agents.append(shown)
    return {"time": system.time, "agents": agents}
