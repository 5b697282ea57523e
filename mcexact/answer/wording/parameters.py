"""The sentences of `mcexact analyze` about a plant with parameters."""

from __future__ import annotations

from mcexact.answer.template import Template

_HAUTUS = "joint_controllability.controllable_hautus"
_RANK = "setpoint.setpoint_rank"

HEADING = Template(
    "parametric-heading",
    "{name:name}: {n:count state}, {m:count channel} {names:set}, {time:time} time, "
    "{parameters:words}{undefined:undefined}",
)

# The answer in words.

NOTHING_FIXED = Template("parametric-nothing-fixed", "For {every:words} no mode is fixed.")
FIXED = Template("parametric-fixed", "For {every:words} the roots of {modes:words} are fixed.")
ANOTHER = Template("parametric-another", "{another:another} mode is fixed where {where:values}.")

# What is proved for all values within ranges, by evidence about boxes.

WITHIN_RANGES = {
    "box_fixed_modes": "no mode is fixed",
    "box_stabilizability": "a decentralized controller of its own stabilizes every plant",
    "box_controllability": "all channels together control every mode",
    "box_observability": "all channels together observe every mode",
}


def _ranges(stem: str, question: str, theorem: str) -> Template:
    said = f"For all values of {{parameters:words}}: {WITHIN_RANGES[question]}."
    return Template(f"parametric-ranges-{stem}", said, theorem)


RANGES = {
    "box_fixed_modes": _ranges("nothing-fixed", "box_fixed_modes", "boxes.regular_not_fixed"),
    "box_stabilizability": _ranges(
        "stabilizable", "box_stabilizability", "S. H. Wang and E. J. Davison 1973"
    ),
    "box_controllability": _ranges("controllable", "box_controllability", _HAUTUS),
    "box_observability": _ranges("observable", "box_observability", _HAUTUS),
}

# The table of all answers.


def _modes(stem: str, label: str, every: str, theorem: str = "") -> tuple[Template, ...]:
    """The sentences on modes: none for every value, none unless, some, some and others."""
    return (
        Template(f"parametric-{stem}-always", f"{every}, for {{every:words}}", theorem, label),
        Template(f"parametric-{stem}-unless", f"{every}, unless {{where:values}}", theorem, label),
        Template(
            f"parametric-{stem}-some",
            ("" if every == "none" else "all but ") + "the roots of {modes:words}, for "
            "{every:words}",
            theorem,
            label,
        ),
        Template(
            f"parametric-{stem}-more",
            ("" if every == "none" else "all but ") + "the roots of {modes:words}; "
            "others, too, where {where:values}",
            theorem,
            label,
        ),
    )


MODES = {
    "fixed_spectrum": _modes("modes", "fixed modes", "none"),
    "joint_controllability": _modes("controllable", "jointly controllable", "every mode", _HAUTUS),
    "joint_observability": _modes("observable", "jointly observable", "every mode", _HAUTUS),
    "channel_controllability": _modes(
        "channel-controllable", "controlled by the channel", "every mode", _HAUTUS
    ),
    "channel_observability": _modes(
        "channel-observable", "observed by the channel", "every mode", _HAUTUS
    ),
}
GRAPH = (
    Template("parametric-graph-always", "{edges:edges}, for {every:words}", label="transfer graph"),
    Template("parametric-graph-lost", "{edges:edges}; {lost:lost}", label="transfer graph"),
)
COMPLETE = (
    Template("parametric-complete-always", "yes, for {every:words}", label="complete"),
    Template("parametric-complete-unless", "yes, unless {where:values}", label="complete"),
    Template("parametric-complete-never", "no, for no value of {t:words}", label="complete"),
)


def _indices(name: str) -> tuple[Template, ...]:
    """The sentences on indices: for every value, or others at some."""
    return (
        Template(
            f"parametric-{name}-indices-always",
            "{indices:indices}, for {every:words}",
            label=f"{name} indices",
        ),
        Template(
            f"parametric-{name}-indices-unless",
            "{indices:indices}, unless {where:values}",
            label=f"{name} indices",
        ),
    )


INDICES = {name: _indices(name) for name in ("controllability", "observability")}
SETPOINT = (
    Template(
        "parametric-setpoint-always",
        "every set-point has an equilibrium, for {every:words}",
        _RANK,
        "set-points",
    ),
    Template(
        "parametric-setpoint-unless",
        "every set-point has an equilibrium, unless {where:values}",
        _RANK,
        "set-points",
    ),
    Template(
        "parametric-setpoint-never",
        "not every set-point has an equilibrium, for any value of {t:words}",
        _RANK,
        "set-points",
    ),
)

# With several parameters: what a certificate along a line implies, and what it says itself.


def _almost(stem: str, said: str, theorem: str = "") -> Template:
    text = f"For almost all values of {{parameters:words}} {said}."
    return Template(f"parametric-almost-{stem}", text, theorem)


ALMOST = {
    "fixed_spectrum": _almost("nothing-fixed", "no mode is fixed"),
    "joint_controllability": _almost(
        "controllable", "all channels together control every mode", _HAUTUS
    ),
    "joint_observability": _almost(
        "observable", "all channels together observe every mode", _HAUTUS
    ),
    "channel_controllability": _almost(
        "channel-controllable", "the channel controls every mode", _HAUTUS
    ),
    "channel_observability": _almost(
        "channel-observable", "the channel observes every mode", _HAUTUS
    ),
    "transfer_graph": _almost("graph", "the transfer graph has these edges: {edges:edges}"),
    "completeness": _almost("complete", "the plant is complete"),
    "setpoint": _almost("setpoint", "every set-point has an equilibrium", _RANK),
}


def _on_line(stem: str, label: str) -> Template:
    return Template(f"parametric-line-{stem}", "{line:words} | {found:words}", label=label)


ON_LINE = {
    "fixed_spectrum": _on_line("modes", "fixed modes"),
    "joint_controllability": _on_line("controllable", "modes that no channel controls"),
    "joint_observability": _on_line("observable", "modes that no channel observes"),
    "controllability_indices": _on_line("controllability-indices", "ranks of [B, AB, …]"),
    "observability_indices": _on_line("observability-indices", "ranks of [C; CA; …]"),
    "transfer_graph": _on_line("graph", "edges of the transfer graph"),
    "setpoint": _on_line("setpoint", "rank of the matrix of equilibria"),
    "channel_controllability": _on_line(
        "channel-controllable", "modes that the channel does not control"
    ),
    "channel_observability": _on_line(
        "channel-observable", "modes that the channel does not observe"
    ),
}
