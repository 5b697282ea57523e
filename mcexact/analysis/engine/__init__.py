"""Algorithms of the decisions: shrunk subspaces, reachability, covering programs, quadratic forms.

This folder answers no question by itself.  The other folders of `analysis` import from this page.

=======================  =============================================================
`obstructions`           the fixed factors of a system, with gains that move all others
`one_channel`            proofs that no more is fixed, by one sequence of one channel
`state_blocks`           the same for blocks of states, which share no gain
`reached_blocks`         the same for what channels control, whatever they measure
`shrunk_subspace`        proofs that a mode is fixed, by Wong sequences modulo a prime
`sparse_loops`           drawn closed loops of sparse systems modulo primes
`sparse_annihilator`     what channels of large sparse systems do not control
`sparse_subspaces`       the same for large sparse systems, by products with sparse matrices
`parametric_modes`       what is fixed for all values of a parameter, and where more is
`parametric_control`     the same for what channels do not control or observe
`parametric_minors`      ranks of matrices of polynomials in a parameter
`mode_hypersurfaces`     what is fixed for almost all values of several parameters
`rank_hypersurfaces`     ranks of matrices of polynomials in several parameters
`parameter_lines`        lines along which both are proved
`named_matrices`         these matrices, made from those of a system
`parametric_structure`   the transfer graph and completeness by such ranks
`parametric_sharing`     the least dimensions that agents must share for every value
`zero_blocks`            proofs that a mode is fixed for all values, or at some
`reachability`           the transfer graph modulo a prime, and zero transfers
`sparse_reachability`    the transfer graph of large sparse systems
`rate`                   root discs, and the best rate that some modes allow
`covering`               covering integer programs, with a branch tree as proof
`lyapunov`               Lyapunov matrices, refined and verified exactly
`smith_doubling`         Lyapunov equations to any precision
`separated_instability`  a quadratic form for a loop with one unstable block
=======================  =============================================================
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
from mcexact.analysis.engine.mode_hypersurfaces import (
    controllability_hypersurfaces,
    mode_hypersurfaces,
)
from mcexact.analysis.engine.obstructions import Decision, Obstruction, decide
from mcexact.analysis.engine.one_channel import MODULI, best_sequences
from mcexact.analysis.engine.parametric_control import parametric_controllability
from mcexact.analysis.engine.parametric_minors import parametric_rank
from mcexact.analysis.engine.parametric_modes import parametric_fixed_spectrum
from mcexact.analysis.engine.parametric_sharing import (
    ParametricSharing,
    shared_dimensions_for_every_value,
)
from mcexact.analysis.engine.parametric_structure import (
    ParametricCompleteness,
    ParametricTransferGraph,
    parametric_completeness,
    parametric_transfer_graph,
)
from mcexact.analysis.engine.rank_hypersurfaces import rank_for_all_values, rank_hypersurfaces
from mcexact.analysis.engine.rate import located
from mcexact.analysis.engine.reachability import (
    Edge,
    strong_components,
    suspected_edges,
    witnessed_powers,
    zero_transfer,
)
from mcexact.analysis.engine.reached_blocks import (
    measured_blocks,
    measured_system,
    transposed_blocks,
)
from mcexact.analysis.engine.separated_instability import separated_instability
from mcexact.analysis.engine.shrunk_subspace import (
    ExactSubspace,
    evidence,
    exact_subspace,
    obstruction_modulo,
)
from mcexact.analysis.engine.sparse_annihilator import annihilator
from mcexact.analysis.engine.sparse_reachability import (
    edge_modulus,
    is_connected,
    is_large_and_sparse,
    reachable_pairs,
    sparse_powers,
)
from mcexact.analysis.engine.sparse_subspaces import fixed_subspaces
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
    "ParametricCompleteness",
    "ParametricSharing",
    "ParametricTransferGraph",
    "QuadraticForm",
    "StateBlock",
    "Tree",
    "annihilator",
    "best_sequences",
    "bounded_blocks",
    "branch_tree",
    "completed_blocks",
    "controllability_hypersurfaces",
    "decide",
    "edge_modulus",
    "evidence",
    "exact_subspace",
    "fixed_subspaces",
    "free_blocks",
    "is_connected",
    "is_large_and_sparse",
    "located",
    "measured_blocks",
    "measured_system",
    "minimize",
    "mode_hypersurfaces",
    "modes_left",
    "obstruction_modulo",
    "parametric_completeness",
    "parametric_controllability",
    "parametric_fixed_spectrum",
    "parametric_rank",
    "parametric_transfer_graph",
    "quadratic_form",
    "rank_for_all_values",
    "rank_hypersurfaces",
    "reachable_pairs",
    "separated_instability",
    "shared_dimensions_for_every_value",
    "sparse_powers",
    "state_blocks",
    "strong_components",
    "suspected_edges",
    "transposed_blocks",
    "witnessed_powers",
    "zero_transfer",
]
