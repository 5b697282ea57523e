"""A fixed mode that gains which vary with time do move: what is said of it speaks of the others."""

import json
from pathlib import Path

import pytest
import sympy

from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.derived.constructions import closed_by
from mcexact.designs import PeriodicController, local_controllers, save_periodic_controller
from mcexact.errors import Impossible
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model import gallery
from mcexact.synthesis.decentralized import design_decentralized
from tests.end_to_end.command_line import run
from tests.wording import says

NAME = "movable-by-periodic-gains"
FILE = Path(gallery.__file__).parent / f"{NAME}.json"
PLANT = gallery.load(NAME)
CONTINUOUS = "gallery:quadruple-tank-pminus"
EVEN, ODD = ("0", "121/500"), ("1", "0")
"""F_1 and F_2 at even and at odd t."""
OVER_TWO_STEPS = Polynomial.of(0, "-363/1000", "-1/4", 1)
X = sympy.Symbol("x")


def gains(values: tuple[str, str]) -> tuple[Matrix, ...]:
    return tuple(Matrix.from_rows([[value]]) for value in values)


def symbolic_loop(F_1: sympy.Expr, F_2: sympy.Expr) -> sympy.Matrix:
    """A + B_1 F_1 C_1 + B_2 F_2 C_2, from the numbers of the file."""
    document = json.loads(FILE.read_text(encoding="utf-8"))

    def matrix(rows: list[list[int | str]]) -> sympy.Matrix:
        return sympy.Matrix([[sympy.Rational(entry) for entry in row] for row in rows])

    loop = matrix(document["A"])
    for F, channel in zip((F_1, F_2), document["channels"], strict=True):
        loop += F * matrix(channel["B"]) * matrix(channel["C"])
    return loop


def test_no_constant_gains_move_the_mode() -> None:
    loop = symbolic_loop(*sympy.symbols("F_1 F_2"))
    assert sympy.expand((sympy.Rational(11, 10) * sympy.eye(3) - loop).det()) == 0
    assert fixed_spectrum(PLANT).polynomial == Polynomial.of("-11/10", 1)


def test_gains_of_period_two_stabilize_it() -> None:
    over_two = closed_by(PLANT, gains(ODD)) @ closed_by(PLANT, gains(EVEN))
    assert characteristic_polynomial(over_two) == OVER_TWO_STEPS
    assert StabilityRegion("discrete").contains_roots_of(OVER_TWO_STEPS)


def test_another_program_finds_the_same_loop_over_two_steps() -> None:
    odd, even = (symbolic_loop(*map(sympy.Rational, F)) for F in (ODD, EVEN))
    polynomial = (odd * even).charpoly(X)
    expected = X**3 - X**2 / 4 - sympy.Rational(363, 1000) * X
    assert sympy.expand(polynomial.as_expr() - expected) == 0
    assert all(abs(root) < 1 for root in polynomial.all_roots())


def test_the_checkers_theorem_speaks_of_linear_time_invariant_control() -> None:
    verdict = check_document(encode(fixed_spectrum(PLANT)).encode())
    assert verdict.verdict == "VALID"
    assert says(verdict.statement, "roots")
    assert says(verdict.statement, "stabilizable invariant")


def test_the_refusal_of_a_design_speaks_of_linear_time_invariant_control() -> None:
    with pytest.raises(Impossible, match="no linear time-invariant decentralized control"):
        design_decentralized(PLANT, radius=1)
    done = run("design", "decentralized", str(FILE), "--radius", "1")
    assert done.status == 1
    assert says(done.stderr, "invariant moves")
    assert f"design decentralized {FILE} --periodic --radius 1`" in done.stderr


@pytest.mark.slow
def test_the_commands_design_certify_check_and_run_a_periodic_controller(tmp_path: Path) -> None:
    gains, proofs = str(tmp_path / "gains.json"), str(tmp_path / "proofs")
    done = run("design", "decentralized", str(FILE), "--periodic", "-o", gains)
    assert (done.status, done.stdout.splitlines()[0]) == (
        0,
        "The decentralized controller of period 2 stabilizes the plant.",
    )
    done = run("certify", str(FILE), gains, "--radius", "9/10", "--certificates", proofs)
    assert (done.status, "over 2 steps" in done.stdout) == (0, True)
    assert run("check", "--controller", gains, proofs).status == 0
    assert run("certify", str(FILE), gains, "--radius", "1/100").status == 1
    done = run("simulate", str(FILE), gains, "--horizon", "4", "--json")
    document = json.loads(done.stdout)
    assert (document["stable"], document["period"], len(document["times"])) == (True, 2, 5)
    done = run("analyze", gains)
    assert (done.status, "mcexact-periodic-controller/1" in done.stderr) == (3, True)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["certify", "FILE", "GAINS", "--gains", "1%"], "leave out --gains"),
        (["certify", "FILE", "GAINS", "--html", "page.html"], "leave out --html"),
        (["simulate", "FILE", "GAINS", "--reference", "1,1"], "leave out --reference"),
        (["simulate", "FILE", "GAINS", "--code", "interpreted"], "leave out --code"),
        (["simulate", "FILE", "GAINS", "-o", "run.html"], "as .csv or .png"),
        (["export", "GAINS", "-o", "code"], "this controller is periodic"),
        (["convert", "GAINS", "-o", "gains.mat"], "this controller is periodic"),
        (["design", "decentralized", "FILE", "--periodic", "--rate", "1"], "takes no --rate"),
        (["design", "decentralized", "FILE", "--longest-period", "3"], "add it"),
        (["design", "decentralized", CONTINUOUS, "--periodic"], "sample the plant"),
    ],
)
def test_what_a_periodic_controller_does_not_have_is_refused_in_one_message(
    tmp_path: Path, arguments: list[str], message: str
) -> None:
    gains = tmp_path / "gains.json"
    phases = [local_controllers(PLANT, [[[one]], [[two]]]) for one, two in (EVEN, ODD)]
    save_periodic_controller(PeriodicController(tuple(phases)), gains)
    known = {"FILE": str(FILE), "GAINS": str(gains)}
    done = run(*(known.get(each, each) for each in arguments))
    of_file = "this controller" in message
    assert (done.status, len(done.messages)) == (3 if of_file else 2, 1)
    assert message in done.stderr
