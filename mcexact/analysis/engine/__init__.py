"""Algorithms of the decisions: shrunk subspaces, reachability, covering programs, quadratic forms.

This folder answers no question by itself.  The other folders of `analysis` import from this page.

========================  =============================================================
`obstructions`            the fixed factors of a system, with gains that move all others
`one_channel`             proofs that no more is fixed, by one sequence of one channel
`state_blocks`            the same for blocks of states, which share no gain
`reached_blocks`          the same for what channels control, whatever they measure
`shrunk_subspace`         proofs that a mode is fixed, by Wong sequences modulo a prime
`reachability`            the transfer graph modulo a prime, and zero transfers
`rate`                    root discs, and the best rate that some modes allow
`covering`                covering integer programs, with a branch tree as proof
`lyapunov`                Lyapunov matrices, refined and verified exactly
`smith_doubling`          Lyapunov equations to any precision
`separated_instability`   a quadratic form for a loop with one unstable block
========================  =============================================================
"""

from mcexact.analysis.engine.covering import (
    DEFAULT_NODE_LIMIT,
    CoveringCut,
    CoveringProgram,
    Node,
    Tree,
    branch_tree,
    minimize,
)
from mcexact.analysis.engine.lyapunov import QuadraticForm, quadratic_form
from mcexact.analysis.engine.obstructions import Decision, Obstruction, decide
from mcexact.analysis.engine.one_channel import MODULI, best_sequences
from mcexact.analysis.engine.rate import located
from mcexact.analysis.engine.reachability import (
    Edge,
    strong_components,
    suspected_edges,
    witnessed_powers,
    zero_transfer,
)
from mcexact.analysis.engine.reached_blocks import measured_blocks, transposed_blocks
from mcexact.analysis.engine.separated_instability import separated_instability
from mcexact.analysis.engine.shrunk_subspace import (
    ExactSubspace,
    evidence,
    exact_subspace,
    obstruction_modulo,
)
from mcexact.analysis.engine.state_blocks import (
    StateBlock,
    bounded_blocks,
    completed_blocks,
    free_blocks,
    modes_left,
    state_blocks,
)

__all__ = [
    "DEFAULT_NODE_LIMIT",
    "MODULI",
    "CoveringCut",
    "CoveringProgram",
    "Decision",
    "Edge",
    "ExactSubspace",
    "Node",
    "Obstruction",
    "QuadraticForm",
    "StateBlock",
    "Tree",
    "best_sequences",
    "bounded_blocks",
    "branch_tree",
    "completed_blocks",
    "decide",
    "evidence",
    "exact_subspace",
    "free_blocks",
    "located",
    "measured_blocks",
    "minimize",
    "modes_left",
    "obstruction_modulo",
    "quadratic_form",
    "separated_instability",
    "state_blocks",
    "strong_components",
    "suspected_edges",
    "transposed_blocks",
    "witnessed_powers",
    "zero_transfer",
]
