"""Records of floating-point answers: what is written down, and what is kept."""

import pytest

from mcexact.crosschecks import gallery, recording, table
from mcexact.crosschecks.demonstration import FloatingAnswers
from mcexact.crosschecks.table import Libraries, libraries_here, libraries_of
from mcexact.model.system import MultiChannelSystem
from tests.wording import says

ELSEWHERE = Libraries((("numpy", "1.26"), ("OpenBLAS", "0.3.23")), "Haswell")
WRONG = FloatingAnswers(7, ((6, 200), (8, 200)), ELSEWHERE)
RIGHT = FloatingAnswers(20, ((6, 200), (8, 200)), ELSEWHERE)
OLDER = {"floating": "no, rank 1 of 2", "libraries": ELSEWHERE.document()}


def integrator():
    return MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])


@pytest.fixture
def two_exhibits(monkeypatch):
    """One that every machine answers wrongly, and one that every machine answers rightly."""
    right = gallery.Exhibit("integrator", "joint controllability", "", integrator)
    wrong = gallery.exhibit("weak-input")
    monkeypatch.setattr(recording, "exhibits", lambda: (wrong, right))
    monkeypatch.setattr(recording, "floating_answers", lambda: WRONG)


@pytest.mark.usefixtures("two_exhibits")
def test_a_wrong_answer_is_recorded_with_the_machine_and_a_right_one_is_not():
    document, right = recording.record({})
    here = libraries_here().document()
    assert document["exhibits"] == {
        "weak-input": {"floating": "no, rank 1 of 2", "libraries": here}
    }
    assert right == ["integrator"]
    assert FloatingAnswers.from_document(document["demonstration"]) == WRONG


@pytest.mark.usefixtures("two_exhibits")
def test_where_this_machine_answers_rightly_the_older_record_is_kept(monkeypatch):
    monkeypatch.setattr(recording, "floating_answers", lambda: RIGHT)
    known = {
        "exhibits": {"integrator": OLDER, "no exhibit any more": OLDER},
        "demonstration": WRONG.document(),
    }
    document, right = recording.record(known)
    assert document["exhibits"]["integrator"] == OLDER
    assert set(document["exhibits"]) == {"weak-input", "integrator"}
    assert FloatingAnswers.from_document(document["demonstration"]) == WRONG
    assert right == ["integrator", "demonstration"]


@pytest.mark.usefixtures("two_exhibits")
def test_the_file_is_written_and_what_is_kept_is_named(monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(recording, "_PLACE", tmp_path / "records.json")
    recording.main()
    first = (tmp_path / "records.json").read_text()
    recording.main()
    assert (tmp_path / "records.json").read_text() == first
    assert says(capsys.readouterr().out, "integrator correctly")


def test_libraries_come_back_from_their_document():
    assert libraries_of(ELSEWHERE.document()) == ELSEWHERE
    assert str(ELSEWHERE) == "numpy 1.26, OpenBLAS 0.3.23 (kernel Haswell)"


def test_numpys_own_library_is_named_and_not_scipys(monkeypatch):
    def blas(place, version):
        return {
            "user_api": "blas",
            "internal_api": "openblas",
            "filepath": f"/site-packages/{place}.libs/libscipy_openblas.so",
            "version": version,
            "architecture": "Zen",
        }

    threads = {"user_api": "openmp", "internal_api": "openmp", "filepath": "", "version": None}
    loaded = [threads, blas("scipy", "2"), blas("numpy", "1")]
    monkeypatch.setattr("threadpoolctl.threadpool_info", lambda: loaded)
    assert libraries_here().versions[-1] == ("OpenBLAS", "1") and libraries_here().kernel == "Zen"
    loaded[:] = [threads]
    assert libraries_here().kernel is None and "unknown" in str(libraries_here())


def test_a_library_that_is_not_installed_is_left_out(monkeypatch):
    monkeypatch.setattr(table, "_LIBRARIES", ("numpy", "no-such-distribution"))
    assert libraries_here().versions[0][0] == "numpy"
    assert "no-such-distribution" not in str(libraries_here())
