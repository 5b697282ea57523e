"""The sentences of `mcexact analyze` about one set of channels, one channel, or delays."""

from __future__ import annotations

from mcexact.answer.template import Template

# The table of fixed modes.

FIXED_MODES = Template(
    "fixed-modes",
    "fixed modes: no {control:control} moves them",
    ("fixed_spectrum",),
    "evidence.shrunk_subspace_fixed_dynamic",
)
FIXED_MODE = Template(
    "fixed-modes-row",
    "{p:polynomial} | {roots:roots} | {stable:yes} | {in_A:int} | {stays:int} | {s:set} | "
    "{rank:int}",
    ("fixed_spectrum",),
)
FIXED_MODES_NOTE = Template(
    "fixed-modes-note",
    "in A: how often; stay: at most so often; rank, below n = {n:int}: that of [xI-A, B of the "
    "channels outside s; C of those in s, 0]",
    ("fixed_spectrum",),
)
FIXED_MODES_MORE = Template(
    "fixed-modes-more", "{k:count more factor}; --json and --html list all", ("fixed_spectrum",)
)

# A set of channels.

PENCIL = Template(
    "pencil",
    "rank of [xI-A, B of the others; C of s, 0] for s = {s:set}, at every mode of A",
    ("spectrum_of_A", "pencil_rank"),
    "closed_loop_spectrum.closed_loop_spectrum",
)
PENCIL_ROW = Template("pencil-row", "{p:polynomial} | {rank:int} | {below:yes}", ("pencil_rank",))
SUBSYSTEM = Template("subsystem", "complementary subsystem of s = {s:set}")
_SUBSYSTEM = ("complementary_subsystem",)
NORMAL_RANK = Template("subsystem-normal-rank", "{rank:int}", _SUBSYSTEM, label="normal rank")
ZEROS = Template(
    "subsystem-zeros", "the roots of {zeros:factors}", _SUBSYSTEM, label="invariant zeros"
)
NO_ZEROS = Template("subsystem-no-zeros", "none", _SUBSYSTEM, label="invariant zeros")
REMNANT = Template("subsystem-remnant", "{p:polynomial}", _SUBSYSTEM, label="remnant polynomial")
SUBSYSTEM_COMPLETE = Template(
    "subsystem-complete",
    "yes: its transfer matrix is not zero, and no rank is below n",
    _SUBSYSTEM,
    label="complete",
)
SUBSYSTEM_ZERO = Template(
    "subsystem-zero", "no: its transfer matrix is zero", _SUBSYSTEM, label="complete"
)
SUBSYSTEM_DROPS = Template(
    "subsystem-drops",
    "no: the rank is below n at the roots of {zeros:factors}",
    _SUBSYSTEM,
    label="complete",
)
SUBSYSTEM_BOTH = Template(
    "subsystem-zero-and-drops",
    "no: its transfer matrix is zero, and the rank is below n at the roots of {zeros:factors}",
    _SUBSYSTEM,
    label="complete",
)

# A channel.

CHANNEL = Template("channel", "channel {name:name}")
_ALONE = {"controllability": "controllable alone", "observability": "observable alone"}
ALONE = {
    what: (
        Template(f"channel-{what}", "every mode", (f"channel_{what}",), label=label),
        Template(
            f"channel-no-{what}",
            "all but {p:modes}",
            (f"channel_{what}",),
            label=label,
        ),
    )
    for what, label in _ALONE.items()
}


def _gains(key: str, premise: str, label: str) -> dict[str, Template]:
    """Whether there are gains, with the indices that they reach; or why not."""
    causes = {
        "controllable": "it does not act on {rest:channels}",
        "observable": "{rest:channels} {rest:do} not act on it",
    }
    return {
        "reached": Template(
            f"{key}-gains", "yes, indices {reached:reached}", (premise,), label=label
        ),
        "stuck": Template(
            f"{key}-stuck",
            "no: no constant gains make channel {name:name} {side:side} at {p:modes}",
            (premise,),
            label=label,
        ),
    } | {
        side: Template(
            f"{key}-unreached-{side}",
            f"no: no constant gains make channel {{name:name}} {side}, since {cause}",
            (premise,),
            "single_channel_gains.single_channel_no_cut",
            label,
        )
        for side, cause in causes.items()
    }


GAINS = {
    want: _gains(f"channel-{want}", f"channel_gains_{want}", f"{want} with gains")
    for want in ("controllable", "observable", "both")
} | {"every": _gains("every-channel", "every_channel", "through every channel")}
# Delays.

DELAYED = {
    name: (
        Template(
            f"{name}-nothing-fixed",
            "nothing, of {n:count state}, {k:count state} shared by each agent",
            (f"{name}_fixed_spectrum",),
            label=f"fixed with delays, {name}",
        ),
        Template(
            f"{name}-fixed",
            "{p:modes}, of {n:count state}, {k:count state} shared by each agent",
            (f"{name}_fixed_spectrum",),
            label=f"fixed with delays, {name}",
        ),
    )
    for name in ("lifted", "held")
}

# Pictures of a page.

PICTURE = Template("picture-graphs", "Graphs")
PICTURE_OUTPUTS = Template("picture-graphs-outputs", "Graphs (agents share outputs)")
PICTURE_NEIGHBORS = Template("picture-neighbor-graph", "neighbor graph: {arcs:arrows}")
PICTURE_TRANSFER = Template(
    "picture-transfer-graph",
    "transfer graph, between different channels: {arcs:arrows}",
    ("transfer_graph",),
)
PICTURE_OBSTRUCTION = Template(
    "picture-obstruction",
    "orange: {s:channels}, the set s of {p:modes}",
    ("fixed_spectrum",),
)
PICTURE_HEARD = Template(
    "picture-heard", "purple: {heard:channels}, from whom some of them receive"
)
PICTURE_DIMENSIONS = Template("picture-dimensions", "Shared states by agent")
PICTURE_LEAST = {
    share: (
        Template(
            f"picture-least-{share.replace('+', '-')}",
            f"{words}: least {{sizes:list}}",
            (f"minimal_shared_dimensions_{share.replace('+', '_')}",),
        ),
        Template(
            f"picture-bound-{share.replace('+', '-')}",
            f"{words}: least {{sizes:list}}, bound {{bound:int}} for each agent",
            (
                f"minimal_shared_dimensions_{share.replace('+', '_')}",
                f"shared_dimension_bound_{share.replace('+', '_')}",
                "neighbor_graph",
                "joint_controllability",
                "joint_observability",
            ),
            theorem,
        ),
        Template(
            f"picture-nothing-{share.replace('+', '-')}",
            f"{words}: no dimensions suffice",
            (f"minimal_shared_dimensions_{share.replace('+', '_')}",),
        ),
    )
    for share, words, theorem in (
        ("outputs+states", "outputs and states shared", "extended_bound.theorem_2"),
        ("states", "states shared without outputs", "extended_bound.remark_2"),
    )
}

# A page.

PAGE_HEADING = Template(
    "page-heading",
    "{n:count state}, {m:count channel}, {time:time} time; {information:information}",
)

# LaTeX.

LATEX_NOTHING_FIXED = Template(
    "latex-nothing-fixed", r"$\Lambda_{{\mathrm{{fixed}}}} = \emptyset$.", ("fixed_spectrum",)
)
LATEX_FIXED_MODE = Template(
    "latex-fixed-mode",
    r"${p:latex}$ & {in_A:int} & {rank:int} & $\{{\text{{{s:latex_names}}}\}}$ \\",
    ("fixed_spectrum",),
)
