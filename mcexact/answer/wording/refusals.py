"""The sentences of refusals: why no requested design exists."""

from __future__ import annotations

from mcexact.answer.template import Template

NOT_CONTROLLABLE = Template(
    "refused-not-controllable",
    "no state feedback moves {p:modes}: the system is not jointly controllable",
    "controllability.uncontrollable_modes",
)
NOT_CONTROLLABLE_IN = Template(
    "refused-not-controllable-in",
    "no state feedback moves {p:modes}, {p:escape} {region:region}: the system is not jointly "
    "controllable",
    "controllability.uncontrollable_modes",
)
UNREACHED = {
    "move": Template(
        "refused-uncontrollable",
        "no controller moves {p:modes}, {p:escape} {region:region}: all channels together do not "
        "control {p:them}",
        "controllability.uncontrollable_modes",
    ),
    "see": Template(
        "refused-unobservable",
        "no controller observes {p:modes}, {p:escape} {region:region}: all channels together do "
        "not observe {p:them}",
        "controllability.uncontrollable_modes",
    ),
}
NOT_OBSERVABLE = Template(
    "refused-not-observable",
    "no distributed observer moves {p:modes} of its errors: all channels together do not observe "
    "{p:them}",
    "controllability.uncontrollable_modes",
)
ERRORS_NOT_COMPLETE = Template(
    "refused-errors-not-complete",
    "the error system for these F_i is not complete: no constant K_i, H_ij let one agent control "
    "and observe all estimation errors",
    "free_assignment.corfmat_morse_converse",
)
ERRORS_FIXED = Template(
    "refused-errors-fixed",
    "no constant K_i, H_ij and no linear time-invariant channel controller move {p:modes} of the "
    "error system for these F_i, {p:escape} {region:region}",
    "evidence.shrunk_subspace_fixed_dynamic",
)
_FIXED_MODES = " control moves {p:modes}, which {sides:sides}, and {p:slow}"
FIXED = Template(
    "refused-fixed",
    "no linear time-invariant decentralized" + _FIXED_MODES,
    "evidence.shrunk_subspace_fixed_dynamic",
)
FIXED_SHARED = Template(
    "refused-fixed-shared",
    "no linear time-invariant distributed"
    + _FIXED_MODES
    + " (shared dimensions {sizes:dimensions})",
    "evidence.shrunk_subspace_fixed_dynamic",
)
_LACK = (
    ": {agents:agents} {agents:need} {k:count shared state} of other agents, and can receive from "
    "{senders:names}"
)
NO_DIMENSIONS = Template(
    "refused-no-dimensions",
    "no shared dimensions allow linear time-invariant control to move the modes that are not fast "
    "enough" + _LACK,
    "extended_bound.extended_no_fixed, extended_bound.extended_states_no_fixed",
)
NOT_CONTROLLED, NOT_OBSERVED = (
    Template(
        f"refused-sharing-in-vain-{verb}",
        "no sharing allows linear time-invariant control to move {p:modes}: all agents "
        f"together do not {verb} {{p:them}}",
        "extended_bound.extended_no_fixed, extended_bound.extended_states_no_fixed",
    )
    for verb in ("control", "observe")
)
NO_CONNECTION = Template(
    "refused-no-connection",
    "no shared dimensions make the transfer graph of the extended system strongly connected"
    + _LACK,
    "transfer_graph.zero_transfer_cut",
)
OUTSIDE = Template("refused-outside", "not every eigenvalue of the loop satisfies {region:region}")
NO_EQUILIBRIUM = Template(
    "refused-no-equilibrium",
    "no equilibrium holds set-points r with {w:combinations}",
    "setpoint.setpoint_unreachable",
)
NO_EQUILIBRIUM_ZERO = Template(
    "refused-no-equilibrium-zero",
    "no equilibrium holds set-points r with {w:combinations}: {place:int} is an invariant zero of "
    "the plant",
    "setpoint.setpoint_unreachable",
)
MODE_OF_THE_INTEGRATORS = Template(
    "refused-mode-of-the-integrators",
    "no stable loop has integrators of the outputs: all channels together do not control the "
    "mode {place:int} of the plant",
    "setpoint.setpoint_output_part",
)
INTEGRATORS_UNREACHED = {
    verb: Template(
        f"refused-integrators-{verb}",
        "the plant with its integrators has {p:modes}, which all channels together do not " + verb,
        "controllability.uncontrollable_modes",
    )
    for verb in ("control", "observe")
}
INTEGRATORS_FIXED = Template(
    "refused-integrators-fixed",
    "no linear time-invariant distributed control of the plant with its integrators moves "
    "{p:modes}, however many states are shared",
    "evidence.shrunk_subspace_fixed_dynamic",
)
