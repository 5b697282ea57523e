"""What is decided or written in one place is not done again elsewhere."""

import ast
from collections.abc import Callable, Iterator

from tests.architecture.test_imports import MODULES, PACKAGE, nodes_of, part_of

TIMES = {"continuous", "discrete"}


def found_outside(*places: str, what: Callable[[ast.AST], bool]) -> list[str]:
    """Where something is done in the package, the checker and these files left out."""
    return [
        f"{path}:{getattr(node, 'lineno', 0)}"
        for path in MODULES
        if part_of(path) != "checker" and str(path.relative_to(PACKAGE)) not in places
        for node in nodes_of(path)
        if what(node)
    ]


def attributes_of(node: ast.AST) -> Iterator[str]:
    """What is asked of objects in an expression."""
    return (part.attr for part in ast.walk(node) if isinstance(part, ast.Attribute))


def compares_time_domains(node: ast.AST) -> bool:
    if not isinstance(node, ast.Compare):
        return False
    parts = [part for side in (node.left, *node.comparators) for part in ast.walk(side)]
    return any(isinstance(part, ast.Constant) and part.value in TIMES for part in parts)


def rounds_an_exact_number(node: ast.AST) -> bool:
    """Whether it is float(Fraction(…)), p / q of a rational number, or an array of exact rows."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Div):
        sides = (node.left, node.right)
        parts = [side.attr if isinstance(side, ast.Attribute) else "" for side in sides]
        return parts == ["numerator", "denominator"]
    if not isinstance(node, ast.Call) or not node.args:
        return False
    called, given = ast.unparse(node.func), node.args[0]
    if called == "float":
        return isinstance(given, ast.Call) and ast.unparse(given.func) == "Fraction"
    if called in {"np.array", "np.asarray"}:
        return not {"rows", "numerators", "coefficients"}.isdisjoint(attributes_of(given))
    return False


def replaces_a_file(node: ast.AST) -> bool:
    return isinstance(node, ast.Call) and ast.unparse(node.func) in {"os.replace", "os.rename"}


def test_time_domains_are_compared_in_one_place() -> None:
    assert found_outside("exact/roots.py", what=compares_time_domains) == []


def test_exact_numbers_become_floats_in_one_place() -> None:
    # Residues below 2**26 are floats in `krylov`, without any rounding.
    elsewhere = found_outside("exact/matrix.py", "exact/krylov.py", what=rounds_an_exact_number)
    assert elsewhere == []


def test_files_are_written_whole_in_one_place() -> None:
    assert found_outside("model/text.py", what=replaces_a_file) == []
