"""The kind about the factors of a neighbor graph, by which bounds exceed the least dimension.

Two numbers belong to a neighbor graph, whatever the plant.  The first is the most relays of two
sets S and R that are apart: nobody in S receives from R, and a relay receives from R and sends to
S.  Sets in the witness attain the number that is claimed to be attained; that no sets have more
than the other number is searched here, from the graph alone.  The second is the most agents outside
a set that send to it, which is m less the size of a smallest dominating set; a branch tree proves
that no dominating set is smaller.
"""

from collections.abc import Iterable
from fractions import Fraction

from .constructions import neighbors_of
from .core.budget import spend
from .core.reading import Json, fields, integer, names, require
from .core.system import System
from .sharing import Program

# Kind ``sharing_gap``: two numbers of the neighbor graph; ``proofs/sharing_gap.md``.


def check_sharing_gap(claim: Json, witness: Json, system: System) -> None:
    """Check the sets that attain both numbers, and that no sets attain more.

    Theorems ``allocation.branch_tree``, ``sharing_gap.boundary_number_domination``,
    ``sharing_gap.relay_number_le``.
    """
    keys = ("relays", "relays_at_most", "boundary", "boundary_at_most")
    relays, relays_at_most, boundary, boundary_at_most = (
        integer(number, f"claim.{key}")
        for key, number in zip(keys, fields(claim, "claim", *keys), strict=True)
    )
    receivers, senders, dominating, tree = fields(
        witness, "witness", "receivers", "senders", "dominating", "tree"
    )
    N = [bits(N_i) for N_i in neighbors_of(system, "subject")]
    spend(10 * system.m * system.m + 100)
    S, R, D = (
        names(listed, f"witness.{key}", system.names)
        for key, listed in (
            ("receivers", receivers),
            ("senders", senders),
            ("dominating", dominating),
        )
    )
    require_relays(N, S, bits(R), relays)
    require_no_more_relays(N, relays_at_most)
    require_boundary(N, D, boundary)
    cuts = [({i for i, N_i in enumerate(N) if N_i >> j & 1}, 1) for j in range(system.m)]
    least = Fraction(system.m - boundary_at_most)
    program = Program([Fraction(1)] * system.m, cuts, "agent", system.names, least)
    program.require_bound(tree, [1] * system.m)


def sharing_gap_statement(claim: Json, system: System) -> str:
    """Both numbers, each attained by some sets, with bounds on all sets."""
    apart = (
        "sets S and R of agents where no agent of S receives messages of R, "
        f"{claim['relays']} agents send to S and receive from R for some, "
        f"and at most {claim['relays_at_most']} for all"
    )
    around = (
        f"of sets s of agents {claim['boundary']} agents outside s send to s for some, "
        f"and at most {claim['boundary_at_most']} for all"
    )
    return (
        f"over its neighbor graph, in which every agent receives from itself, of {apart}; {around}"
    )


def heard_by(N: list[int], s: list[int]) -> int:
    """N_s, the union of the N_i of a set of agents."""
    together = 0
    for i in s:
        together |= N[i]
    return together


def require_relays(N: list[int], S: list[int], R: int, relays: int) -> None:
    """Stop unless S is apart from R, and they have so many relays."""
    heard = heard_by(N, S)
    place = "witness.receivers"
    require(not heard & R, "apart", place, "one of these receives messages of a sender")
    attained = sum(1 for j, N_j in enumerate(N) if heard >> j & 1 and N_j & R)
    require(attained == relays, "claim", "claim.relays", f"these sets have {attained} relays")


def require_boundary(N: list[int], D: list[int], boundary: int) -> None:
    """Stop unless N_D has all agents, so that its boundary is its complement, of this size."""
    m, place = len(N), "witness.dominating"
    require(heard_by(N, D) == (1 << m) - 1, "dominating", place, "somebody sends to none of these")
    outside = m - len(D)
    require(outside == boundary, "claim", "claim.boundary", f"{outside} agents are outside")


def require_no_more_relays(N: list[int], most: int) -> None:
    """Stop if two sets S and R that are apart have more than ``most`` relays.

    N_i is the set of bits N[i].  The search decides of one agent after the other whether it is in
    R.  S is apart from R iff no agent of S is among those that receive from R, so that the largest
    such S has the most relays, and more agents in R make S smaller.  A branch ends where too few
    agents are left that can be relays: those that send to an agent that may still be in S, and
    receive from R or from an undecided agent.

    Open: see ``proofs/OPEN.md``.
    """
    m = len(N)
    if most >= m - 2:
        return  # an agent of S and one of R are no relays
    followers = [bits(i for i in range(m) if N[i] >> j & 1) for j in range(m)]
    everybody = (1 << m) - 1
    branches = [(everybody, 0)]
    while branches:
        spend(15 * m + 100)
        undecided, receive = branches.pop()
        rest = everybody & ~receive
        able = [j for j in range(m) if followers[j] & rest & ~(1 << j)]
        if sum(1 for j in able if receive >> j & 1 or N[j] & undecided) <= most:
            continue
        relays = sum(1 for j in able if receive >> j & 1)
        place = "claim.relays_at_most"
        require(relays <= most, "claim", place, f"two sets that are apart have {relays} relays")
        changes = [(followers[j] & rest).bit_count() * (undecided >> j & 1) for j in range(m)]
        # Some agent receives from an undecided one and not yet from R, so that this one counts.
        j = changes.index(max(changes))
        undecided &= ~(1 << j)
        branches += [(undecided, receive), (undecided, receive | followers[j])]


def bits(members: Iterable[int]) -> int:
    """A set of positions as the bits of an integer."""
    found = 0
    for i in members:
        found |= 1 << i
    return found
