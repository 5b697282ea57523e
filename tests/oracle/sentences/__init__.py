"""An oracle of sentences: whether the English of a sentence is true of its plant.

`JUDGES` has a judge for the key of each rule that can be judged from the plant, the request and the
controller; `UNJUDGED` has the reason for each other one.  A judge takes the values that fill the
template and decides by its own algebra, enumeration or simulation: never by the package, by its
checker, or by what was printed before.  What is said of all plants in a box, or at all values, is
judged at drawn ones, which can only refute it.
"""

from __future__ import annotations

from tests.oracle.sentences import (
    designs,
    failures,
    members,
    modulo,
    nearby,
    parameters,
    patterns,
    performance,
    saturation,
    sharing,
    time_varying,
)
from tests.oracle.sentences.analysis import JUDGES
from tests.oracle.sentences.cases import Case, Facts, Region, Said, UnjudgedError, plant_of, said

_LONG = "that a question was left out since it takes long claims nothing of the plant"
_SEARCH = "that a search ended at its limit depends on the search"
_TITLE = "a title claims nothing"
_OPTION = "which option asks further claims nothing of the plant"
_PROOF = "how long or by which method a proof is says nothing of the plant"
UNJUDGED = {
    "controllability-indices-left-out": _LONG,
    "observability-indices-left-out": _LONG,
    "table-links-limit": _SEARCH,
    "least-outputs-states-limit": _SEARCH,
    "least-states-limit": _SEARCH,
    "modulo-option-unobservable": _OPTION,
    "modulo-option-uncontrollable": _OPTION,
    "modulo-option-both": _OPTION,
    "picture-fixed-mode": _TITLE,
    "picture-graphs": _TITLE,
    "picture-graphs-outputs": _TITLE,
    "picture-dimensions": _TITLE,
    "certify-loop": _TITLE,
    "periodic-loop": _TITLE,
    "time-varying-option": _OPTION,
    "design-measured": "it says that figures are not certified, and claims none",
    "allocate-proof": _PROOF,
    "allocate-nested-proof": _PROOF,
    "allocate-within-proof": _PROOF,
    "allocate-links-proof": _PROOF,
    "certify-decided": _PROOF,
    "certify-decided-blocks": _PROOF,
}


def verdict(sentence: Said, case: Case) -> bool | None:
    """Whether a sentence is true; None if this one is beyond its judge."""
    try:
        return JUDGES[sentence.rule](sentence, case)
    except UnjudgedError:
        return None


__all__ = [
    "JUDGES", "UNJUDGED", "Case", "Facts", "Region", "Said", "UnjudgedError", "designs", "failures",
    "members", "modulo", "nearby", "parameters", "patterns", "performance", "plant_of", "said",
    "saturation", "sharing", "time_varying", "verdict",
]  # fmt: skip
