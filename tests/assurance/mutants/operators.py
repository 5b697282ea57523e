"""What is changed: Cosmic Ray's operators, a choice of their many replacements, and four more."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import Any

import cosmic_ray.plugins
import parso
from cosmic_ray.operators.operator import Operator

REPLACED = {
    "Add": "Sub Mul",
    "Sub": "Add Mul",
    "Mul": "Add FloorDiv",
    "Div": "Mul FloorDiv",
    "FloorDiv": "Mul Add",
    "Mod": "Add FloorDiv",
    "Pow": "Mul Add",
    "RShift": "LShift",
    "LShift": "RShift",
    "BitOr": "BitAnd BitXor",
    "BitAnd": "BitOr BitXor",
    "BitXor": "BitOr BitAnd",
    "Eq": "NotEq LtE GtE",
    "NotEq": "Eq Lt Gt",
    "Lt": "LtE NotEq GtE",
    "LtE": "Lt Eq Gt",
    "Gt": "GtE NotEq LtE",
    "GtE": "Gt Eq Lt",
    "Is": "IsNot",
    "IsNot": "Is",
}
"""By what Cosmic Ray's two families of replacements replace an operator; it knows all pairs."""

MESSAGES = {
    "malformed": 1,
    "incomplete": 2,
    "require": 3,
    "require_asked": 3,
    "expect": 1,
    "Refused": 3,
}
"""The position of the message for a human in calls of these functions."""

CHARGED = {"spend", "build"}
"""The functions that are told how much work a step is."""

ESTIMATES = {
    "LIMB", "_limbs", "_terms", "_turns", "build", "extractions", "fractions", "inversions",
    "limbs", "limbs_of", "products", "reductions", "table",
}  # fmt: skip
"""The functions that say how much work a step is, or how long its numbers are."""

COSTS = {"longest", "turn", "turns", "units"}
"""The names, of attributes too, that only such estimates have."""

TOLD = {"message"}
"""The name that only messages for a human have."""

GUARDS = {"abstractmethod", "frozen", "strict"}
"""The arguments, and the decorator, by which the checker watches over itself; no document makes a
difference."""

SQUARE = {
    "TwoPolynomials", "_determinant", "_lost_at", "characteristic_polynomial", "check_stability",
    "lifted", "require_spectrum", "scaled_bound", "transformed",
}  # fmt: skip
"""The functions and the class in which only square matrices are called A, A_F or M, so that they
have as many rows as columns."""

PAIRS = (
    ("any", "all"),
    ("min", "max"),
    ("floor", "ceil"),
    ("inputs", "outputs"),
    ("lcm", "gcd"),
    ("B", "C"),
    ("nrows", "ncols"),
    ("controllable", "observable"),
)
COUNTERPARTS = {a: b for pair in PAIRS for a, b in (pair, pair[::-1])}
"""Names, and those that one could write in their place by mistake."""


class DeleteStatement(Operator):
    """Replace a call that stands alone, ``raise`` or an augmented assignment by ``pass``."""

    def mutation_positions(self, node: Any) -> Iterator[tuple[Any, Any]]:
        if node.type == "simple_stmt" and _acts(node.children[0]):
            yield node.start_pos, node.children[0].end_pos

    def mutate(self, node: Any, index: int) -> Any:
        first = node.children[0]
        node.children[0] = parso.python.tree.Name("pass", first.start_pos, _blanks(first))
        return node

    @classmethod
    def examples(cls) -> tuple[Any, ...]:
        return ()


def _acts(node: Any) -> bool:
    """Whether a simple statement does something besides giving a name to a value."""
    augmented = node.type == "expr_stmt" and getattr(node.children[1], "type", "") in (
        "augassign",
        "operator",
    )
    if augmented:
        sign = node.children[1].get_code().strip()
        return len(sign) > 1 and sign.endswith("=")
    return node.type in ("atom_expr", "power", "raise_stmt")


def _blanks(node: Any) -> str:
    return str(node.get_first_leaf().prefix)


class NegateFilter(Operator):
    """Negate the condition of a comprehension."""

    def mutation_positions(self, node: Any) -> Iterator[tuple[Any, Any]]:
        if node.type in ("comp_if", "old_comp_if"):
            yield node.children[1].start_pos, node.children[1].end_pos

    def mutate(self, node: Any, index: int) -> Any:
        node.children[1] = parso.parse(f" (not ({node.children[1].get_code().strip()}))")
        return node

    @classmethod
    def examples(cls) -> tuple[Any, ...]:
        return ()


class SwapMembership(Operator):
    """Replace ``in`` by ``not in`` and the other way round."""

    def mutation_positions(self, node: Any) -> Iterator[tuple[Any, Any]]:
        if node.type == "comparison":
            for sign in node.children[1::2]:
                if sign.get_code().split() in (["in"], ["not", "in"]):
                    yield sign.start_pos, sign.end_pos

    def mutate(self, node: Any, index: int) -> Any:
        signs = [
            k
            for k in range(1, len(node.children), 2)
            if node.children[k].get_code().split() in (["in"], ["not", "in"])
        ]
        other = " in" if "not" in node.children[signs[index]].get_code().split() else " not in"
        node.children[signs[index]] = parso.parse(other)
        return node

    @classmethod
    def examples(cls) -> tuple[Any, ...]:
        return ()


class SwapName(Operator):
    """Replace a name by its counterpart."""

    def mutation_positions(self, node: Any) -> Iterator[tuple[Any, Any]]:
        called = node.type == "name" and node.value in COUNTERPARTS
        if called and not node.is_definition():
            yield node.start_pos, node.end_pos

    def mutate(self, node: Any, index: int) -> Any:
        node.value = COUNTERPARTS[node.value]
        return node

    @classmethod
    def examples(cls) -> tuple[Any, ...]:
        return ()


KNOWN = {each.__name__: each for each in (DeleteStatement, NegateFilter, SwapMembership, SwapName)}


def register() -> None:
    """Let Cosmic Ray know the operators of this file, and use a choice of its own."""
    known = cosmic_ray.plugins.OPERATOR_PROVIDERS
    known["core"] = {name: known["core"][name] for name in known["core"] if _is_chosen(name)}
    known["mcexact"] = KNOWN


def _is_chosen(name: str) -> bool:
    """Whether an operator of Cosmic Ray is used: of the replacements only those in ``REPLACED``."""
    if name == "NoOp":
        return False
    if not name.startswith(("ReplaceBinaryOperator_", "ReplaceComparisonOperator_")):
        return True
    _, before, after = name.split("_")
    return after in REPLACED[before].split()


Span = tuple[tuple[int, int], tuple[int, int]]


def outside(source: str) -> list[Span]:
    """The parts of a file that no verdict depends on: annotations, messages, costs and guards."""
    spans = []
    for node in ast.walk(ast.parse(source)):
        parts: list[ast.AST | None] = []
        if isinstance(node, ast.arg | ast.AnnAssign):
            parts = [node.annotation]
        elif isinstance(node, ast.FunctionDef):
            parts = [node if node.name in ESTIMATES else node.returns]
            guards = [d for d in node.decorator_list if getattr(d, "id", "") in GUARDS]
            spans += [((each.lineno, 0), (each.lineno + 1, 0)) for each in guards]
        elif isinstance(node, ast.Expr | ast.Assign | ast.AugAssign):
            right = node.value if isinstance(node, ast.Assign) else None
            values = right.elts if isinstance(right, ast.Tuple) else [node]
            targets = [getattr(part, "id", getattr(part, "attr", "")) for part in _targets(node)]
            named = len(targets) == len(values)
            parts = [
                part
                for k, part in enumerate(values)
                if (named and targets[k] in COSTS | TOLD)
                or any(map(_is_about_cost, ast.walk(part)))
            ]
        elif isinstance(node, ast.Call):
            name = getattr(node.func, "id", getattr(node.func, "attr", ""))
            if name in MESSAGES:
                parts = list(node.args[MESSAGES[name] :])
            parts += [each.value for each in node.keywords if each.arg in GUARDS]
        for part in parts:
            if part is not None:
                spans.append(_span(part))
    return spans


def _span(node: Any) -> Span:
    """Where a part of a file begins and ends."""
    return (node.lineno, node.col_offset), (node.end_lineno, node.end_col_offset)


def dimensions(source: str) -> list[Span]:
    """The numbers of rows and of columns of the matrices called A, A_F or M that are square."""
    spans = []
    parts = [part for part in ast.parse(source).body if getattr(part, "name", "") in SQUARE]
    for node in (node for part in parts for node in ast.walk(part)):
        if isinstance(node, ast.Attribute) and node.attr in ("nrows", "ncols"):
            owner = getattr(node.value, "id", getattr(node.value, "attr", ""))
            if owner in ("A", "A_F", "M"):
                spans.append(_span(node))
    return spans


def _targets(node: ast.AST) -> list[ast.expr]:
    """What an assignment gives values to, part by part, or what an augmented one changes."""
    if isinstance(node, ast.AugAssign):
        return [node.target]
    if not isinstance(node, ast.Assign):
        return []
    first = node.targets[0]
    return first.elts if isinstance(first, ast.Tuple) else [first]


NAMED_ORDER = ("_LtE", "_GtE", "_Lt", "_Gt")
LEAST = {"gcd": 1, "denominator": 1, "len": 0, "nrows": 0, "ncols": 0}
"""The least value of functions and of attributes."""


def same_comparisons(source: str) -> list[tuple[Span, tuple[str, ...]]]:
    """The comparisons that some replacements leave as they are, and the ends of their names.

    Texts, as in ``time == "discrete"``, have no order that means anything; and what is compared
    with its least value, as in ``gcd(a, b) == 1``, is never below it.
    """
    spans: list[tuple[Span, tuple[str, ...]]] = []
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.Compare):
            continue
        parts = [node.left, *node.comparators]
        values = [part.value for part in parts if isinstance(part, ast.Constant)]
        if any(type(value) is str for value in values):
            spans.append((_span(node), NAMED_ORDER))
        elif len(parts) == 2 and values == [_least(node.left)]:
            same = {
                ast.Eq: "_Eq_LtE",
                ast.NotEq: "_NotEq_Gt",
                ast.Gt: "_Gt_NotEq",
                ast.LtE: "_LtE_Eq",
            }
            if suffix := same.get(type(node.ops[0])):
                spans.append((_span(node), (suffix,)))
    return spans


def _least(node: ast.expr) -> int | None:
    """The least value of a part of a comparison, if that is known."""
    if isinstance(node, ast.Call):
        node = node.func
    return LEAST.get(getattr(node, "id", getattr(node, "attr", "")))


def _is_about_cost(node: ast.AST) -> bool:
    """Whether a part of a statement says how much work a step is."""
    if isinstance(node, ast.Attribute):
        return node.attr in CHARGED | ESTIMATES
    return isinstance(node, ast.Call) and getattr(node.func, "id", "") in CHARGED | ESTIMATES


def within(start: tuple[int, int], end: tuple[int, int], spans: list[Span]) -> bool:
    """Whether a place lies in one of some parts."""
    return any(a <= tuple(start) and tuple(end) <= b for a, b in spans)
