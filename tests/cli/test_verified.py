"""The second checker, beside `mcexact check`: what it may say, and what it cannot change."""

from __future__ import annotations

import json
import re
import shlex
import shutil
import stat
import subprocess
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import pytest

import mcexact
from mcexact import NeighborGraph, fixed_spectrum
from mcexact.analysis.stability import certify_stability, open_loop_spectrum
from mcexact.answer import protocol
from mcexact.checker.kinds import check_document
from mcexact.cli import verified
from mcexact.derived.constructions import (
    augmented_outputs,
    dual,
    extended_system,
    feedback,
    full_output,
    merged,
    restricted,
)
from mcexact.exact.matrix import Matrix
from mcexact.model import gallery
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.loop import closed_loop
from tests.checker import (
    test_closed_loop_spectrum,
    test_completeness,
    test_controllability,
    test_fixed_spectrum,
    test_setpoint,
    test_stability,
    test_transfer_graph,
)
from tests.checker.handmade import Document, changed, checked
from tests.checker.handmade import certificate as by_hand
from tests.checker.handmade import plant as plant_by_hand
from tests.cli.calling import call
from tests.wording import says

PLANT = "liu2020-3ch-no-communication"


@pytest.fixture
def certificate(tmp_path: Path) -> Path:
    """The fixed spectrum of the paper's example."""
    path = tmp_path / "fixed_spectrum.json"
    path.write_text(protocol.encode(fixed_spectrum(gallery.load(PLANT))), "ascii")
    return path


@pytest.fixture
def program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder beside Python and on the search path, for a program that says what a test wants."""
    folder = tmp_path / "programs"
    folder.mkdir()
    monkeypatch.setenv("PATH", str(folder))
    monkeypatch.setattr("sys.executable", str(folder / "python"))
    verified.program.cache_clear()
    yield folder / verified.NAME
    verified.program.cache_clear()


def saying(program: Path, line: str, version: str = verified.VERSION, status: int = 0) -> None:
    """Make a program that prints a line for every file."""
    program.write_text(
        f'#!/bin/sh\n[ "$1" = --version ] && echo "{version}" && exit\n'
        f'for file in "$@"; do echo {shlex.quote(line)}; done\nexit {status}\n'
    )
    program.chmod(program.stat().st_mode | stat.S_IXUSR)


def stated(certificate: Path) -> str:
    """The statement of a certificate behind its digest."""
    verdict = check_document(certificate.read_bytes())
    return f"{verdict.statement_digest} {verdict.statement}"


def test_without_the_program_nothing_is_said(program: Path, certificate: Path) -> None:
    status, out, err = call("check", str(certificate))
    assert (status, err) == (0, "") and out.startswith("VALID ")


def test_a_program_of_another_version_is_not_asked(program: Path, certificate: Path) -> None:
    saying(program, "INVALID witness: no", version="mcexact-verified 0")
    status, _, err = call("check", str(certificate))
    assert (status, err) == (0, "")


def test_what_it_confirms_is_said(program: Path, certificate: Path) -> None:
    saying(program, f"CONFIRMED {stated(certificate)}")
    status, out, err = call("check", str(certificate))
    assert status == 0 and out.startswith("VALID ")
    assert err == f"mcexact-verified confirms {str(certificate)!a}\n"
    _, out, _ = call("check", "--json", str(certificate))
    assert json.loads(out)["verdicts"][0]["verified"] == "CONFIRMED"


def test_it_is_not_asked_if_it_shall_not_be(program: Path, certificate: Path) -> None:
    saying(program, "INVALID witness: no")
    status, out, err = call("check", "--no-verified", "--json", str(certificate))
    assert (status, err) == (0, "") and "verified" not in json.loads(out)["verdicts"][0]


@pytest.mark.parametrize("line", ["INVALID witness: no", "MALFORMED file: no", "ERROR checker: no"])
def test_a_contradiction_is_a_bug_of_one_of_the_two(
    program: Path, certificate: Path, line: str
) -> None:
    saying(program, line, status=1)
    status, _, err = call("check", str(certificate))
    assert status == 70 and line.partition(" ")[0] in err


@pytest.mark.parametrize("word", ["plant", "roots of x", "3 states"])
def test_another_statement_is_not_confirmed(program: Path, certificate: Path, word: str) -> None:
    digest, _, statement = stated(certificate).partition(" ")
    assert word in statement
    saying(program, f"CONFIRMED {digest} {statement.replace(word, 'other')}")
    status, _, err = call("check", str(certificate))
    assert status == 70 and "states something else" in err


def test_another_digest_is_not_confirmed(program: Path, certificate: Path) -> None:
    statement = stated(certificate).partition(" ")[2]
    saying(program, f"CONFIRMED {'0' * 64} {statement}")
    status, _, err = call("check", str(certificate))
    assert status == 70 and "states something else" in err


def test_a_program_that_ends_early_confirms_nothing(program: Path, certificate: Path) -> None:
    program.write_text(f'#!/bin/sh\n[ "$1" = --version ] && echo "{verified.VERSION}"\n')
    program.chmod(0o755)
    status, _, err = call("check", str(certificate))
    assert status == 70 and "ended early" in err


def test_a_program_that_takes_too_long_is_stopped(program: Path, certificate: Path) -> None:
    program.write_text(
        f'#!/bin/sh\n[ "$1" = --version ] && echo "{verified.VERSION}" && exit\nexec /bin/sleep 9\n'
    )
    program.chmod(0o755)
    status, out, err = call("check", "--timeout", "0.5", str(certificate))
    assert (status, err) == (0, "") and out.startswith("VALID ")


def test_a_sentence_has_the_layer_of_its_weakest_certificate(program: Path, tmp_path: Path) -> None:
    folder, plant = tmp_path / "proofs", mcexact.MultiChannelSystem([[-1]], [[[1]]], [[[1]]])
    mcexact.save_system(plant, tmp_path / "plant.json")
    assert call("analyze", str(tmp_path / "plant.json"), "--certificates", str(folder))[0] == 0
    line = shlex.quote(f"CONFIRMED {stated(folder / 'fixed_spectrum.json')}")
    program.write_text(
        f'#!/bin/sh\n[ "$1" = --version ] && echo "{verified.VERSION}" && exit\n'
        'for file in "$@"; do case "$file" in\n'
        f"*/fixed_spectrum.json) echo {line};;\n"
        "*) echo INCOMPLETE kind: no;; esac; done\n"
    )
    program.chmod(0o755)
    status, out, err = call("check", "--json", str(folder))
    rows = json.loads(out)["verdicts"]
    (number,) = (row["number"] for row in rows if row.get("file") == "fixed_spectrum.json")
    said = [row for row in rows if row.get("premises") and row["verdict"] == "IMPLIED"]
    for row in said:
        weak = [name for name in row["premises"].split(", ") if name != number]
        assert row["verified"] == (f"VALID {', '.join(weak)}" if weak else "CONFIRMED")
    many = sum(row["verified"] == "CONFIRMED" for row in said)
    assert status == 0 and 0 < many < len(said)
    assert f" {many} of {len(said)} " in err
    assert not any("verified" in row for row in rows if not row.get("premises", number))


def test_what_it_cannot_verify_is_not_mentioned(program: Path, certificate: Path) -> None:
    saying(program, "INCOMPLETE kind: not a kind that is verified here", status=5)
    status, _, err = call("check", str(certificate))
    assert (status, err) == (0, "")


def test_a_false_certificate_is_not_given_to_it(program: Path, certificate: Path) -> None:
    saying(program, f"CONFIRMED {stated(certificate)}")
    certificate.write_text(certificate.read_text("ascii").replace('"rank":2', '"rank":1'), "ascii")
    status, out, err = call("check", str(certificate))
    assert (status, err) == (1, "") and out.startswith("INVALID ")


def test_a_theorem_needs_the_program_and_one_certificate(program: Path, certificate: Path) -> None:
    file = str(certificate.parent / "plant.v")
    status, _, err = call("check", "--rocq", file, str(certificate))
    assert status == 3 and "make verified" in err
    saying(program, "INVALID witness: no", status=1)
    verified.program.cache_clear()
    status, _, err = call("check", "--no-verified", "--rocq", file, str(certificate))
    assert status == 3 and "does not confirm" in err
    assert call("check", "--rocq", file, str(certificate), str(certificate))[0] == 2


@pytest.mark.parametrize("given", [0, 2])
def test_a_theorem_about_no_single_certificate_is_refused_before_the_work(
    program: Path, certificate: Path, given: int
) -> None:
    rest = [str(certificate)] * given if given else ["--manifest", str(certificate.parent)]
    status, out, err = call("check", "--rocq", str(certificate.parent / "plant.v"), *rest)
    assert (status, out) == (2, "") and says(err, "rocq certificate")
    status, out, err = call("check", "--rocq", str(certificate.parent / "plant.v"), "-")
    assert (status, out) == (2, "") and "in a file" in err


def test_a_theorem_of_a_file_whose_name_is_like_an_option(
    program: Path, certificate: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(certificate.parent)
    certificate.rename(certificate.parent / "-s.json")
    program.write_text(
        f'#!/bin/sh\n[ "$1" = --version ] && echo "{verified.VERSION}" && exit\necho "$1 $2"\n'
    )
    program.chmod(0o755)
    assert verified.rocq_file("-s.json") == "--rocq ./-s.json\n"


def test_a_theorem_that_takes_too_long_or_cannot_be_made_is_an_error(
    program: Path, certificate: Path
) -> None:
    program.write_text(
        f'#!/bin/sh\n[ "$1" = --version ] && echo "{verified.VERSION}" && exit\nexec /bin/sleep 9\n'
    )
    program.chmod(0o755)
    file = certificate.parent / "plant.v"
    asked = ("check", "--no-verified", "--rocq", str(file), str(certificate))
    status, _, err = call(*asked, "--timeout", "0.5")
    assert status == 3 and "not within 0.5 s" in err and not file.exists()
    program.unlink()  # after its version was read
    status, _, err = call(*asked)
    assert status == 3 and says(err, "could run")


BUILT = verified.program() is not None


def of_a_loop(plant: mcexact.MultiChannelSystem) -> mcexact.MultiChannelSystem:
    """The loop in which agent i shares x_i and keeps z_i: ẋ_i = y_i1/2, ż_i = x_i − z_i."""
    ones = [Matrix.from_rows([[1]] * channel.B.ncols) for channel in plant.channels]
    first = [Matrix.from_rows([[1] + [0] * (channel.C.nrows - 1)]) for channel in plant.channels]
    unit, half = Matrix.from_rows([[1]]), Matrix.from_rows([["1/2"]])
    agents = tuple(
        AgentProgram(
            channel.name,
            1,
            1,
            LinearMap({i: half @ first[i]}),
            LinearMap({}, {i: unit}, -unit),
            LinearMap({i: -(ones[i] @ first[i])}, {i: ones[i]}, ones[i]),
        )
        for i, channel in enumerate(plant.channels)
    )
    return closed_loop(plant, Controller(plant.time, "", agents)).system


def spectrum_of_a_loop(plant: mcexact.MultiChannelSystem) -> Any:
    """The characteristic polynomial of a loop."""
    return open_loop_spectrum(of_a_loop(plant))


def stability_of_a_loop(plant: mcexact.MultiChannelSystem) -> Any:
    """Whether a loop is stable, by its characteristic polynomial."""
    return certify_stability(of_a_loop(plant), method="polynomial")


QUESTIONS = (
    mcexact.completeness,
    mcexact.fixed_spectrum,
    mcexact.joint_controllability,
    mcexact.joint_observability,
    mcexact.setpoint_solvability,
    mcexact.transfer_graph,
)
OF_MATRICES = (open_loop_spectrum, spectrum_of_a_loop, stability_of_a_loop)
"""Questions about plants without feedthrough alone."""


@pytest.mark.skipif(not BUILT, reason="needs the program: make verified")
@pytest.mark.parametrize("name", gallery.names())
def test_both_checkers_agree_about_every_published_plant(name: str, tmp_path: Path) -> None:
    plant, paths, statements = gallery.load(name), [], []
    known = plant.D is None  # what makes a plant without feedthrough of it is not verified there
    for question in (*QUESTIONS, *(OF_MATRICES if known else ())):
        path = tmp_path / f"{question.__name__}.json"
        path.write_text(protocol.encode(question(plant)), "ascii")
        verdict = check_document(path.read_bytes())
        assert verdict.verdict == "VALID"
        paths.append(str(path))
        statements.append(verdict.statement)
    found = verified.confirmations(paths, statements)
    assert [answer.confirmed for answer in found] == [known] * len(paths)


def under_feedback(plant: mcexact.MultiChannelSystem) -> mcexact.MultiChannelSystem:
    """The plant with gains whose entries have different denominators."""
    gains = [
        Matrix.from_rows([[f"{i + 1}/{i + 2}"] * plant.q(i)] * plant.p(i)) for i in range(plant.m)
    ]
    return feedback(plant, gains)


def ring(plant: mcexact.MultiChannelSystem) -> mcexact.MultiChannelSystem:
    """The plant with the outputs of one neighbor measured by each agent as well."""
    return augmented_outputs(plant, NeighborGraph.ring(plant.names))


SUBJECTS: dict[str, tuple[Callable[..., Any], Callable[..., Any], Callable[..., Any]]] = {
    "feedback": (
        under_feedback,
        open_loop_spectrum,
        lambda document: document["subject"][0]["gains"][0]["entries"][0].__setitem__(0, 5),
    ),
    "augmented_outputs": (
        ring,
        mcexact.transfer_graph,
        lambda document: document["system"].update(neighbors={"1": [], "2": [], "3": []}),
    ),
    "extended": (
        lambda plant: extended_system(plant, [1, 0, 2], graph=NeighborGraph.ring(plant.names)),
        open_loop_spectrum,
        lambda document: document["subject"][0].update(dimensions=[1, 1, 2]),
    ),
    "full_output": (
        lambda plant: full_output(plant, 1),
        mcexact.transfer_graph,
        lambda document: document["subject"][0].update(channel="1"),
    ),
    "merged": (
        lambda plant: merged(plant, [["1", "3"], ["2"]]),
        mcexact.transfer_graph,
        lambda document: document["subject"][0].update(parts=[["1"], ["2", "3"]]),
    ),
    "restricted": (
        lambda plant: restricted(plant, ["1", "3"]),
        mcexact.setpoint_solvability,
        lambda document: document["subject"][0].update(channels=["2", "3"]),
    ),
}
"""For each construction a system, a question with another answer after an edit, and the edit."""


def answered(path: Path, document: Document) -> tuple[Any, Any]:
    """The verdict of the checker, and the answer of the program."""
    path.write_text(json.dumps(document), "ascii")
    verdict = check_document(path.read_bytes())
    (answer,) = verified.confirmations([str(path)], [verdict.statement])
    return verdict, answer


@pytest.mark.skipif(not BUILT, reason="needs the program: make verified")
@pytest.mark.parametrize("name", SUBJECTS)
def test_both_checkers_agree_about_what_constructions_make(name: str, tmp_path: Path) -> None:
    make, _, _ = SUBJECTS[name]
    made = make(gallery.load(PLANT))
    for system in (made, under_feedback(dual(made))):
        for question in (*QUESTIONS, open_loop_spectrum):
            document = json.loads(protocol.encode(question(system)))
            assert document["subject"][0]["construction"] == name
            verdict, answer = answered(tmp_path / "certificate.json", document)
            assert verdict.verdict == "VALID" and answer.confirmed, (question, answer)


@pytest.mark.skipif(not BUILT, reason="needs the program: make verified")
def test_sub_states_alone_are_shared(tmp_path: Path) -> None:
    ring = NeighborGraph.ring(("1", "2", "3"))
    system = extended_system(gallery.load(PLANT), [2, 1, 0], "states", ring)
    document = json.loads(protocol.encode(mcexact.transfer_graph(system)))
    assert answered(tmp_path / "certificate.json", document)[1].confirmed
    document["subject"][0]["share"] = "outputs"
    verdict, answer = answered(tmp_path / "malformed.json", document)
    assert (verdict.verdict, answer.verdict) == ("MALFORMED", "MALFORMED")


@pytest.mark.skipif(not BUILT, reason="needs the program: make verified")
@pytest.mark.parametrize("name", SUBJECTS)
def test_what_is_true_of_one_subject_is_not_confirmed_of_another(name: str, tmp_path: Path) -> None:
    make, question, edit = SUBJECTS[name]
    document = json.loads(protocol.encode(question(make(gallery.load(PLANT)))))
    assert answered(tmp_path / "true.json", document)[1].confirmed
    edit(document)
    verdict, answer = answered(tmp_path / "false.json", document)
    assert verdict.verdict == answer.verdict != "VALID"
    document["subject"][0]["more"] = 1
    verdict, answer = answered(tmp_path / "malformed.json", document)
    assert (verdict.verdict, answer.verdict) == ("MALFORMED", "MALFORMED")


@pytest.mark.skipif(not BUILT, reason="needs the program: make verified")
@pytest.mark.parametrize(
    ("question", "explained", "subject"),
    [
        (open_loop_spectrum, {"up"}, "of the plant"),
        (spectrum_of_a_loop, {"up", "system_loop"}, "of the loop of the controller with the plant"),
        (stability_of_a_loop, {"within", "system_loop"}, "of the loop of the controller with the"),
    ],
)
def test_the_head_of_a_theorem_explains_the_words_that_it_has(
    question: Callable[[mcexact.MultiChannelSystem], Any],
    explained: set[str],
    subject: str,
    tmp_path: Path,
) -> None:
    path = tmp_path / "certificate.json"
    path.write_text(protocol.encode(question(gallery.load(PLANT))), "ascii")
    head, _, rest = verified.rocq_file(str(path)).partition("*)")
    said = re.search(r"^Theorem .*?^Proof", rest, re.MULTILINE | re.DOTALL)
    assert said is not None and subject in head
    for text in (head, said[0]):
        assert set(re.findall(r"\b(?:up|within|system_loop)\b", text)) == explained


@pytest.mark.skipif(not BUILT, reason="needs the program: make verified")
@pytest.mark.parametrize("zero", [True, False])
def test_no_invariant_zero_is_confirmed_where_set_points_can_be_held(
    zero: bool, tmp_path: Path
) -> None:
    plant = mcexact.MultiChannelSystem([[-1]], [[[1]]], [[[1]]])
    document = json.loads(protocol.encode(mcexact.setpoint_solvability(plant)))
    document["claim"]["invariant_zero"] = zero
    document["witness"]["point" if zero else "normal"] = (
        1 if zero else {"denominator": 1, "coefficients": [[[1, 0]]]}
    )
    path = tmp_path / "setpoint.json"
    path.write_text(json.dumps(document), "ascii")
    assert check_document(path.read_bytes()).verdict == "INVALID"
    (answer,) = verified.confirmations([str(path)], [""])
    assert answer.verdict == "INVALID"


NOT_INVERTIBLE = [
    (
        "a modulus that divides a denominator of B, not of A",
        plant_by_hand([[1]], ([["1/3"]], [[1]])),
        ({"polynomial": [-1, 1]}, {"moduli": [3, 5]}),
        "VALID",
    ),
    (
        "a composite modulus with a factor in common with a pivot",
        plant_by_hand([[1, 0], [7, 1]], ([[1], [0]], [[1, 0]])),
        ({"polynomial": [1, -2, 1]}, {"moduli": [77]}),
        "INVALID",
    ),
]


@pytest.mark.skipif(not BUILT, reason="needs the program: make verified")
@pytest.mark.parametrize("row", NOT_INVERTIBLE, ids=lambda row: row[0])
def test_what_has_no_inverse_modulo_l_is_no_contradiction(
    row: tuple[str, Document, tuple[Document, Document], str], tmp_path: Path
) -> None:
    _, system, parts, verdict = row
    document = by_hand("closed_loop_spectrum", system, *parts)
    found, path = checked(document), tmp_path / "spectrum.json"
    assert found.verdict == verdict
    path.write_text(json.dumps(document), "ascii")
    (answer,) = verified.confirmations([str(path)], [found.statement])
    assert answer.verdict == "INCOMPLETE"


@pytest.mark.skipif(not BUILT, reason="needs the program: make verified")
@pytest.mark.parametrize(
    ("l", "words"), [(7, ("VALID", "CONFIRMED")), (9, ("INVALID", "INCOMPLETE"))]
)
def test_a_denominator_of_gains_that_cancels_is_no_contradiction(
    l: int, words: tuple[str, str], tmp_path: Path
) -> None:
    claim = {"channels": ["1"], "dimension": 0, "controllable": False}
    document = by_hand(
        "controllability",
        plant_by_hand([[1]], ([[0]], [[1]])),
        {**claim, "uncontrollable_polynomial": [-1, 1]},
        {"modulus": l, "annihilator": {"denominator": 1, "entries": [[1]]}, "pivots": [0]},
    )
    gains = [{"denominator": 3, "entries": [[2]]}]
    document["subject"] = [{"construction": "feedback", "gains": gains}]
    verdict, answer = answered(tmp_path / "certificate.json", document)
    assert (verdict.verdict, answer.verdict) == words


OF_LOOPS = (test_closed_loop_spectrum, test_stability)
OF_PLANTS = (
    test_completeness,
    test_controllability,
    test_fixed_spectrum,
    test_setpoint,
    test_transfer_graph,
)


def _table(rows: Iterable[tuple[Any, ...]]) -> Iterator[tuple[str, Document]]:
    """The reasons and the documents of a table, after the changes that it makes."""
    for reason, document, *rest in rows:
        edits = rest[0] if rest else ()
        yield (
            reason,
            changed(document, *((edits,) if edits and isinstance(edits[0], str) else edits)),
        )


def _beyond(document: Document) -> bool:
    """Whether verified/README.md says that such a certificate is not verified."""
    claim, witness = document["claim"], document["witness"]
    match document["kind"]:
        case "stability":
            limits = not {"damping", "largest_modulus"}.isdisjoint(claim)
            return limits or witness.get("method") != "polynomial"
        case "fixed_spectrum":
            return document == test_fixed_spectrum.TEN  # 2 is no unit modulo 10
    return False


@pytest.mark.skipif(not BUILT, reason="needs the program: make verified")
def test_by_hand_it_confirms_what_is_valid_and_nothing_else(tmp_path: Path) -> None:
    table = [row for each in OF_LOOPS for row in _table((*each.ACCEPTED, *each.REJECTED))]
    table += [row for each in OF_PLANTS for row in each.ACCEPTED]
    table += [(reason, document) for reason, document, _ in test_fixed_spectrum.UNPROVED]
    paths, verdicts = [], [checked(document) for _, document in table]
    for k, (_, document) in enumerate(table):
        paths.append(str(tmp_path / f"{k}.json"))
        Path(paths[-1]).write_text(json.dumps(document), "ascii")
    found = verified.confirmations(paths, [verdict.statement for verdict in verdicts])
    for (name, document), verdict, answer in zip(table, verdicts, found, strict=True):
        valid = verdict.verdict == "VALID"
        assert answer.confirmed == (valid and not _beyond(document)), (name, answer)
        assert answer.verdict in ("CONFIRMED", "INCOMPLETE") or not valid, (name, answer)
        assert answer.verdict not in ("ERROR", ""), (name, answer)


PROOFS = Path(__file__).parents[2] / "proofs"
"""The theorems that the kernel rests on, once `make verified` has compiled them."""
THEOREMS = (PLANT, "compleib-tf1", "quadruple-tank-pminus", "siljak-two-subsystems-farina")


@pytest.mark.skipif(not BUILT, reason="needs the program: make verified")
@pytest.mark.parametrize(("order", "word"), [([0, 1], "CONFIRMED"), ([1, 0], "INVALID")])
def test_wrong_evidence_is_refused_where_no_dimension_is_left_to_prove(
    order: list[int], word: str, tmp_path: Path
) -> None:
    """No input moves anything, and the blocks are in an order that A allows, or in the other."""
    system = {
        "time": "continuous",
        "A": [[0, 1], [0, 0]],
        "channels": [{"name": "1", "B": [[], []], "C": [[0, 0]]}],
    }
    claim = {
        "channels": ["1"],
        "dimension": 0,
        "controllable": False,
        "uncontrollable_polynomial": [0, 0, 1],
    }
    witness = {
        "blocks": [{"states": [a], "evidence": None} for a in order],
        "measured": None,
        "annihilator": {"denominator": 1, "entries": [[1, 0], [0, 1]]},
        "pivots": [0, 1],
    }
    head = {"format": "mcexact-certificate/1", "kind": "controllability", "system": system}
    document = json.dumps({**head, "subject": [], "claim": claim, "witness": witness})
    path = tmp_path / "certificate.json"
    path.write_text(document, "ascii")
    call = [str(verified.program()), str(path)]
    line = subprocess.run(call, capture_output=True, text=True, check=False).stdout
    assert line.split()[0] == word
    assert check_document(document.encode()).verdict == word.replace("CONFIRMED", "VALID")


def proved(file: Path) -> bool:
    """Whether Coq reads and proves a file."""
    call = ["coqc", "-Q", str(PROOFS), "mcexact", "-w", "none", str(file)]
    return subprocess.run(call, capture_output=True, check=False).returncode == 0


@pytest.mark.slow
@pytest.mark.skipif(
    not BUILT or not (PROOFS / "kernel" / "subjects.vo").exists() or shutil.which("coqc") is None,
    reason="needs the compiled proofs: make verified",
)
@pytest.mark.parametrize("question", (*QUESTIONS, *OF_MATRICES), ids=lambda each: each.__name__)
@pytest.mark.parametrize("name", THEOREMS)
def test_coq_proves_the_theorem_about_a_published_plant(
    name: str, question: Callable[[mcexact.MultiChannelSystem], Any], tmp_path: Path
) -> None:
    certificate, theorem = tmp_path / "certificate.json", tmp_path / "theorem.v"
    certificate.write_text(protocol.encode(question(gallery.load(name))), "ascii")
    assert call("check", "--rocq", str(theorem), str(certificate))[0] == 0
    assert proved(theorem)
    text = theorem.read_text("ascii")
    other = re.sub(r"Definition plant.* := \(ZSystem \d+ (\d+)", _doubled, text)
    theorem.write_text(other, "ascii")
    assert other != text and not proved(theorem)


@pytest.mark.slow
@pytest.mark.skipif(
    not BUILT or not (PROOFS / "kernel" / "subjects.vo").exists() or shutil.which("coqc") is None,
    reason="needs the compiled proofs: make verified",
)
@pytest.mark.parametrize("name", SUBJECTS)
def test_coq_proves_the_theorem_about_what_a_construction_makes(name: str, tmp_path: Path) -> None:
    certificate, theorem = tmp_path / "certificate.json", tmp_path / "theorem.v"
    system = SUBJECTS[name][0](gallery.load(PLANT))
    every = (*QUESTIONS, open_loop_spectrum)
    for question in every if name == "feedback" else (mcexact.fixed_spectrum,):
        certificate.write_text(protocol.encode(question(system)), "ascii")
        assert call("check", "--rocq", str(theorem), str(certificate))[0] == 0
        assert proved(theorem)


def _doubled(match: re.Match[str]) -> str:
    """Another denominator, and so half the plant."""
    return f"{match[0][: -len(match[1])]}{2 * int(match[1])}"
