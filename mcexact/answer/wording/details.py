"""The sentences of `mcexact analyze` about single modes, channels, sets of them, and pictures."""

from __future__ import annotations

from mcexact.answer.template import Template

# The table of fixed modes.

FIXED_MODES = Template(
    "fixed-modes",
    "fixed modes: no {control:control} moves them",
    "evidence.shrunk_subspace_fixed_dynamic",
)
FIXED_MODE = Template(
    "fixed-modes-row",
    "{p:polynomial} | {roots:roots} | {stable:yes} | {in_A:int or open} | {stays:int} | {s:set} | "
    "{rank:int}",
)
FIXED_MODES_NOTE = Template(
    "fixed-modes-note",
    "in A: multiplicity in A; fixed: how many of these are fixed at most; rank: that of [xI-A, B "
    "of the channels outside s; C of those in s, 0], which is below n = {n:int}",
)

# A set of channels.

PENCIL = Template(
    "pencil",
    "rank of [xI-A, B of the others; C of s, 0] for s = {s:set}, at every mode of A",
    "closed_loop_spectrum.closed_loop_spectrum",
)
PENCIL_ROW = Template("pencil-row", "{p:polynomial} | {rank:int} | {below:yes}")
SUBSYSTEM = Template("subsystem", "complementary subsystem of s = {s:set}", claims=False)
NORMAL_RANK = Template("subsystem-normal-rank", "{rank:int}", label="normal rank")
ZEROS = Template("subsystem-zeros", "the roots of {zeros:factors}", label="invariant zeros")
NO_ZEROS = Template("subsystem-no-zeros", "none", label="invariant zeros")
REMNANT = Template("subsystem-remnant", "{p:polynomial}", label="remnant polynomial")
SUBSYSTEM_COMPLETE = Template(
    "subsystem-complete",
    "yes: its transfer matrix is not zero, and no rank is below n",
    label="complete",
)
SUBSYSTEM_ZERO = Template("subsystem-zero", "no: its transfer matrix is zero", label="complete")
SUBSYSTEM_DROPS = Template(
    "subsystem-drops", "no: the rank is below n at the roots of {zeros:factors}", label="complete"
)
SUBSYSTEM_BOTH = Template(
    "subsystem-zero-and-drops",
    "no: its transfer matrix is zero, and the rank is below n at the roots of {zeros:factors}",
    label="complete",
)

# A channel.

CHANNEL = Template("channel", "channel {name:name}", claims=False)
_ALONE = {"controllability": "controllable alone", "observability": "observable alone"}
ALONE = {
    what: (
        Template(f"channel-{what}", "every mode", label=label),
        Template(f"channel-no-{what}", "all but {p:modes}", label=label),
    )
    for what, label in _ALONE.items()
}


# Pictures of a page.

PICTURE = Template("picture-graphs", "Graphs", claims=False)
PICTURE_OUTPUTS = Template("picture-graphs-outputs", "Graphs (agents share outputs)", claims=False)
PICTURE_NEIGHBORS = Template("picture-neighbor-graph", "neighbor graph: {arcs:arrows}")
PICTURE_TRANSFER = Template(
    "picture-transfer-graph", "transfer graph, between different channels: {arcs:arrows}"
)
PICTURE_OBSTRUCTION = Template(
    "picture-obstruction", "orange: {s:channels}, the set s of {p:modes}"
)
PICTURE_HEARD = Template(
    "picture-heard", "purple: {heard:channels}, from which some of them receive"
)
PICTURE_DIMENSIONS = Template("picture-dimensions", "Shared states by agent", claims=False)

# A page.

PAGE_HEADING = Template(
    "page-heading",
    "{n:count state}, {m:count channel}, {time:time} time; {information:information}",
)

# LaTeX.

LATEX_NOTHING_FIXED = Template(
    "latex-nothing-fixed", r"$\Lambda_{{\mathrm{{fixed}}}} = \emptyset$."
)
LATEX_FIXED_MODE = Template(
    "latex-fixed-mode",
    r"${p:latex}$ & {in_A:int or open} & {rank:int} & $\{{\text{{{s:latex_names}}}\}}$ \\",
)
