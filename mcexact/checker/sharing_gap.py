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

from .budget import spend
from .constructions import neighbors_of
from .reading import Json, fields, integer, names, require
from .sharing import Program
from .system import System

# Kind ``sharing_gap``: two numbers of the neighbor graph; ``proofs/sharing_gap.md``.


def check_sharing_gap(claim: Json, witness: Json, system: System) -> None:
    """Check the sets that attain both numbers, and that no sets attain more.

    Theorem ``allocation.branch_tree``.
    """
    keys = ("relays", "relays_at_most", "boundary", "boundary_at_most")
    relays, most, boundary, farthest = (
        integer(number, f"claim.{key}")
        for key, number in zip(keys, fields(claim, "claim", *keys), strict=True)
    )
    listed = fields(witness, "witness", "receivers", "senders", "dominating", "tree")
    m, N = system.m, [bits(N_i) for N_i in neighbors_of(system, "subject")]
    spend(10 * m * m + 100)
    S, R, D = (bits(names(each, "witness", system.names)) for each in listed[:3])
    apart = not any(S >> i & 1 and N[i] & R for i in range(m))
    require(apart, "apart", "witness.receivers", "one of these receives messages of a sender")
    heard = bits(j for j in range(m) if any(S >> i & 1 and N[i] >> j & 1 for i in range(m)))
    attained = sum(1 for j in range(m) if heard >> j & 1 and N[j] & R)
    require(attained == relays, "claim", "claim.relays", f"these sets have {attained} relays")
    require_no_more_relays(N, most)
    reached = [j for j in range(m) if any(D >> i & 1 and N[i] >> j & 1 for i in range(m))]
    require(
        len(reached) == m, "dominating", "witness.dominating", "somebody sends to none of these"
    )
    outside = m - D.bit_count()
    require(outside == boundary, "claim", "claim.boundary", f"{outside} agents are outside")
    cuts = [({i for i in range(m) if N[i] >> j & 1}, 1) for j in range(m)]
    least = Fraction(m - farthest)
    Program([Fraction(1)] * m, cuts, "agent", system.names, least).require_bound(listed[3], [1] * m)


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
        if any(changes):
            j = changes.index(max(changes))
            undecided &= ~(1 << j)
            branches += [(undecided, receive), (undecided, receive | followers[j])]


def bits(members: Iterable[int]) -> int:
    """A set of positions as the bits of an integer."""
    found = 0
    for i in members:
        found |= 1 << i
    return found
