"""Sweeps: the answers are those of one by one, checked, and none is lost or made twice."""

import functools
import json
import multiprocessing
import os
import threading
from collections.abc import Callable
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from mcexact.analysis.controllability import joint_controllability
from mcexact.analysis.fixed_modes import pencil_rank
from mcexact.answer import protocol
from mcexact.derived.drawn.systems import Draw, drawn_system
from mcexact.errors import InputError, NotWritten, UsageError
from mcexact.exact.rational import Limits
from mcexact.model import gallery
from mcexact.model.box import Box
from mcexact.model.files import save_system
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import system_text
from mcexact.model.text import canonical
from mcexact.sweeps.jobs import Job, Outcome, decide
from mcexact.sweeps.questions import QUESTIONS
from mcexact.sweeps.run import Record, read_records, sweep
from tests.wording import says

DRAWS = [Draw(seed, states=3, fixed_degree=1 if seed % 2 else None) for seed in range(6)]


def by_number(records: Any) -> list[Record]:
    return sorted(records, key=lambda record: record.number)


def refuse(job: Job) -> Outcome:
    raise AssertionError(f"{job.name} is decided again")


def die(job: Job, seeds: tuple[int, ...]) -> Outcome:
    """End the process on some draws."""
    if isinstance(job.source, Draw) and job.source.seed in seeds:
        os._exit(9)
    return decide(job)


def die_once(job: Job, mark: str) -> Outcome:
    """End the process the first time."""
    if not os.path.exists(mark):
        Path(mark).touch()
        os._exit(9)
    return decide(job)


def answer_about_another(job: Job) -> Outcome:
    """The right answer to the same question about something else."""
    other = decide(Job("other", Draw(99, states=5), job.questions))
    return other | {"digest": decide(job)["digest"]}


def answer_falsely(job: Job) -> Outcome:
    """A claim that the witness does not carry."""
    outcome = decide(job)
    made = json.loads(outcome["certificates"]["fixed_spectrum"])
    made["claim"]["stabilizable"] = not made["claim"]["stabilizable"]
    return outcome | {"certificates": {"fixed_spectrum": canonical(made)}}


def answer_something_else(job: Job) -> Outcome:
    return decide(Job(job.name, job.source, ("completeness",)))


def answer_under_another_name(job: Job) -> Outcome:
    """A true certificate about this very system, but not the one that was asked for."""
    other = decide(Job(job.name, job.source, ("completeness",)))
    return other | {"certificates": {"fixed_spectrum": other["certificates"]["completeness"]}}


def observability_for_controllability(job: Job) -> Outcome:
    """The same kind of certificate, of the dual."""
    other = decide(Job(job.name, job.source, ("joint_observability",)))
    made = other["certificates"]["joint_observability"]
    return other | {"certificates": {"joint_controllability": made}}


def controllability_of_one_channel(job: Job) -> Outcome:
    """The same kind of certificate, of fewer channels."""
    made = protocol.encode(joint_controllability(job.system(), ["u1"]))
    return decide(job) | {"certificates": {"joint_controllability": made}}


def test_every_question_is_answered_as_it_is_one_by_one() -> None:
    system = gallery.load("liu2020-3ch-no-communication")
    [record] = sweep([system], list(QUESTIONS))
    assert (record.system, record.digest) == (
        {"n": 3, "m": 3, "time": "continuous"},
        system.digest(),
    )
    assert list(record.answers) == list(QUESTIONS)
    for name, question in QUESTIONS.items():
        document = protocol.document(question.decide(system))
        assert record.answers[name]["claim"] == document["claim"]
        assert json.loads(record.certificates[name]) == document


@pytest.mark.parametrize("workers", [1, 3])
def test_draws_are_those_of_their_seeds_whoever_decides_them(workers: int) -> None:
    records = by_number(sweep(DRAWS, workers=workers))
    assert [record.name for record in records] == [f"seed {draw.seed}" for draw in DRAWS]
    assert [record.digest for record in records] == [drawn_system(draw).digest() for draw in DRAWS]
    assert all(
        record.answers["fixed_spectrum"]["claim"]["factors"]
        for record, draw in zip(records, DRAWS, strict=True)
        if draw.fixed_degree
    )


def test_a_sweep_that_was_interrupted_goes_on(tmp_path: Path) -> None:
    results = tmp_path / "results.jsonl"
    begun = sweep(DRAWS, results=results)
    first = [next(begun), next(begun)]
    begun.close()  # type: ignore[attr-defined]
    with results.open("ab") as stream:
        stream.write(b'{"format": "mcexact-sweep/1", "half a li')
    again = by_number(sweep(DRAWS, results=results))
    assert len(again) == len(DRAWS)
    assert {record.digest for record in first} <= {record.digest for record in again}
    assert by_number(sweep(DRAWS, results=results, work=refuse)) == again
    assert len(results.read_text().splitlines()) == len(read_records(results)) == len(DRAWS)
    assert [record.answers for record in by_number(sweep(DRAWS))] == [
        record.answers for record in again
    ]


def test_other_questions_or_other_limits_of_work_are_asked_anew(tmp_path: Path) -> None:
    results = tmp_path / "results.jsonl"
    list(sweep(DRAWS[:1], results=results))
    [record] = sweep(DRAWS[:1], ["completeness"], results=results)
    assert list(record.answers) == ["completeness"]
    assert len(read_records(results)) == 2


def test_what_ended_at_a_limit_is_tried_again_and_what_is_malformed_is_not(tmp_path: Path) -> None:
    results, bad = tmp_path / "results.jsonl", tmp_path / "bad.json"
    bad.write_text("{}")

    def limited(job: Job) -> Outcome:
        if isinstance(job.source, Draw):
            return {"error": {"status": 4, "message": "the time limit was reached"}}
        return decide(job)

    sources: list[Any] = [bad, DRAWS[0]]
    with ThreadPoolExecutor(1) as threads:
        ended = by_number(sweep(sources, results=results, executor=threads, work=limited))
    assert [record.error["status"] for record in ended if record.error] == [3, 4]
    asked: list[str] = []

    def counted(job: Job) -> Outcome:
        asked.append(job.name)
        return decide(job)

    with ThreadPoolExecutor(1) as threads:
        again = by_number(sweep(sources, results=results, executor=threads, work=counted))
    assert asked == ["seed 0"]
    assert again[0].error == ended[0].error and again[1].error is None


def test_a_file_that_cannot_be_read_stops_nothing(tmp_path: Path) -> None:
    good, malformed = tmp_path / "good.json", tmp_path / "malformed.json"
    save_system(gallery.load("hidden-triple-mode"), good)
    malformed.write_text('{"format": "mcexact-system/1"}')
    records = by_number(sweep([tmp_path / "missing.json", malformed, good, good]))
    assert [record.error and record.error["status"] for record in records] == [3, 3, None, None]
    assert "no such file" in str(records[0].error)
    assert records[2].answers == records[3].answers
    [small] = sweep([good], limits=Limits(bytes=10))
    assert small.error is not None and small.error["status"] == 3


def test_a_job_that_kills_its_process_costs_only_itself() -> None:
    records = by_number(sweep(DRAWS, workers=2, work=functools.partial(die, seeds=(1, 4))))
    failed = [record.name for record in records if record.error]
    assert failed == ["seed 1", "seed 4"]
    assert all(
        r.error is None or (r.error["status"], "twice" in r.error["message"]) == (70, True)
        for r in records
    )


def test_a_job_that_was_lost_by_accident_is_done_once_more(tmp_path: Path) -> None:
    work = functools.partial(die_once, mark=str(tmp_path / "mark"))
    assert [record.error for record in sweep(DRAWS, workers=2, work=work)] == [None] * len(DRAWS)


@pytest.mark.parametrize(
    ("work", "why"),
    [
        (answer_about_another, "not accepted"),
        (answer_falsely, "not accepted"),
        (answer_something_else, "do not belong to the questions"),
    ],
    ids=["another system", "a false claim", "another question"],
)
def test_an_answer_that_the_checker_does_not_accept_is_not_believed(
    work: Callable[[Job], Outcome], why: str
) -> None:
    for source in (DRAWS[1], gallery.load("hidden-triple-mode")):
        [record] = sweep([source], work=work)
        assert record.error is not None and record.error["status"] == 70
        assert why in record.error["message"] and not record.answers


@pytest.mark.parametrize(
    ("question", "work"),
    [
        ("fixed_spectrum", answer_under_another_name),
        ("joint_controllability", observability_for_controllability),
        ("joint_controllability", controllability_of_one_channel),
    ],
    ids=["another kind", "the dual", "fewer channels"],
)
def test_a_true_certificate_that_answers_something_else_is_no_answer(
    question: str, work: Callable[[Job], Outcome]
) -> None:
    [record] = sweep([gallery.load("hidden-triple-mode")], [question], work=work)
    assert record.error is not None and "about something else" in record.error["message"]


def test_jobs_are_made_when_there_is_room_for_them() -> None:
    made = 0

    def endless() -> Any:
        nonlocal made
        while True:
            made += 1
            yield DRAWS[0]

    with ThreadPoolExecutor(1) as threads:
        begun = sweep(endless(), executor=threads)
        next(begun)
        begun.close()  # type: ignore[attr-defined]
    assert made <= 4


def test_an_executor_of_dask_decides_too() -> None:
    distributed = pytest.importorskip("distributed")
    with distributed.Client(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=":0"
    ) as client:
        with pytest.raises(UsageError, match=r"client\.get_executor\(\)"):
            sweep(DRAWS, executor=client)
        with client.get_executor() as executor:
            records = by_number(sweep(DRAWS[:2], executor=executor))
    assert [record.error for record in records] == [None, None]


GONE = "the scheduler is gone"


class Broken(Executor):
    """An executor that takes one job and is never heard of again."""

    def submit(self, *_: Any, **__: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.set_exception(ValueError(GONE))
        return future


def test_what_an_executor_says_of_itself_is_kept_as_an_error() -> None:
    [record] = sweep(DRAWS[:1], executor=Broken())
    assert record.error == {"status": 70, "message": f"ValueError: {GONE}"}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"workers": 0}, "1 to 256 workers, found 0"),
        ({"workers": True}, "found True"),
        ({"questions": ()}, "found none"),
        ({"questions": "completness"}, "found 'completness'"),
        ({"executor": "threads"}, "expected a concurrent.futures.Executor"),
    ],
    ids=["no workers", "a flag", "no question", "a misprint", "no executor"],
)
def test_calls_that_make_no_sense_are_refused_at_once(
    arguments: dict[str, Any], message: str
) -> None:
    with pytest.raises(UsageError, match=message.replace("(", r"\(")):
        sweep(DRAWS, **arguments)


def test_what_names_no_system_is_refused() -> None:
    with pytest.raises(UsageError, match="found int"):
        list(sweep([3]))  # type: ignore[list-item]


def test_a_file_of_something_else_is_left_alone(tmp_path: Path) -> None:
    other = tmp_path / "plant.json"
    save_system(gallery.load("hidden-triple-mode"), other)
    before = other.read_bytes()
    with pytest.raises(InputError, match="line 1: expected a record"):
        next(sweep(DRAWS, results=other))
    with pytest.raises(InputError, match="cannot be"):
        next(sweep(DRAWS, results=tmp_path))
    assert other.read_bytes() == before


def test_two_sweeps_do_not_write_one_file(tmp_path: Path) -> None:
    pytest.importorskip("fcntl")
    results = tmp_path / "results.jsonl"
    begun = sweep(DRAWS, results=results)
    next(begun)
    with pytest.raises(UsageError, match="another sweep"):
        next(sweep(DRAWS, results=results))
    begun.close()  # type: ignore[attr-defined]
    assert len(list(sweep(DRAWS, results=results))) == len(DRAWS)


def test_a_sweep_that_is_given_up_ends_its_processes() -> None:
    own = set(multiprocessing.active_children())
    begun = sweep([Draw(0), Draw(1, states=3)], work=_stuck_after_the_first, workers=1)
    next(begun)
    begun.close()  # type: ignore[attr-defined]
    assert set(multiprocessing.active_children()) <= own


def _stuck_after_the_first(job: Job) -> Outcome:
    if isinstance(job.source, Draw) and job.source.seed:
        threading.Event().wait()
    return decide(job)


def test_answers_are_kept_where_another_question_stays_open(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    plant = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [1]]], [[[1, 1]]])
    box = Box.relative(plant, "1/2").system
    asked = ["completeness", "box_fixed_modes"]
    [failing] = sweep([box], asked)
    assert failing.error is None and "member" in failing.answers["box_fixed_modes"]
    monkeypatch.setattr("mcexact.sweeps.jobs.failing_member", lambda system, wanted: None)
    path = tmp_path / "answers.jsonl"
    [record] = sweep([box], asked, results=path, executor=ThreadPoolExecutor(1))
    assert record.error is not None and record.error["status"] == 4 and not record.final
    assert list(record.answers) == ["completeness"] and record.system is not None
    assert says(record.explain(), "proof found") and "complete" in record.explain()
    [kept] = read_records(path).values()
    assert kept == record


def test_a_plant_outside_of_the_radii_shows_no_failure() -> None:
    plant = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [1]]], [[[1, 1]]])
    near, far = (Box.relative(plant, part).system for part in ("1/10", "1/2"))
    of_far = decide(Job("far", system_text(far).encode(), ("box_fixed_modes",)))

    def forged(job: Job) -> Outcome:
        return of_far | {"digest": near.digest()}

    [record] = sweep([near], ["box_fixed_modes"], work=forged, executor=ThreadPoolExecutor(1))
    assert not record.answers and record.error is not None and record.error["status"] == 70
    [record] = sweep([far], ["box_controllability"], work=forged, executor=ThreadPoolExecutor(1))
    assert record.error is not None and record.error["status"] == 70


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no full device")
def test_a_stream_keeps_no_records_and_is_not_read() -> None:
    """Reading the device, which has no end, took all memory."""
    assert read_records("/dev/full") == {}
    assert len(list(sweep(DRAWS[:1], results="/dev/null"))) == 1
    with pytest.raises(NotWritten, match="/dev/full: cannot be written"):
        list(sweep(DRAWS[:1], results="/dev/full"))


ROUNDED = MultiChannelSystem(
    [["-0.30000000000000004", "0.7"], ["0.3", "-0.7"]], [[["0.1"], ["-0.1"]]], [[[1, 0]]]
)
"""No input moves the sum of both states, but for a rounding error."""
JOINT = ["fixed_spectrum", "joint_controllability", "joint_observability"]


def test_a_record_says_where_rounding_errors_decide_and_is_read_again(tmp_path: Path) -> None:
    results = tmp_path / "results.jsonl"
    exact = MultiChannelSystem([[-1, 1], [1, -1]], [[[1], [-1]]], [[[1, 0]]])
    first, second = by_number(sweep([ROUNDED, exact], JOINT, results=results))
    assert {each["lost"] for each in first.nearby} == {"unstable", "uncontrollable"}
    assert all(each["within"] == "rounding" and each["statement"] for each in first.nearby)
    assert "rounding errors" in first.to_row()["nearby"] and "rounding errors" in first.explain()
    assert not second.nearby and second.to_row()["nearby"] is None
    [again] = sweep([ROUNDED], JOINT, results=results, work=refuse)
    assert again.to_dict() == first.to_dict()


def forged(change: Callable[[dict[str, str]], dict[str, str]], job: Job) -> Outcome:
    """The right answers with other certificates about plants nearby."""
    outcome = decide(job)
    return outcome | {"nearby": change(outcome["nearby"])}


def rank_of(system: MultiChannelSystem, mode: Any) -> str:
    return protocol.encode(pencil_rank(system, [], mode))


FAR = MultiChannelSystem([["-0.3", "0.6"], ["0.3", "-0.6"]], [[["0.1"], ["-0.1"]]], [[[1, 0]]])
FORGERIES: dict[str, Callable[[dict[str, str]], dict[str, str]]] = {
    "a plant farther away": lambda made: {"unstable": rank_of(FAR, 0)},
    "the given plant": lambda made: {"unstable": rank_of(ROUNDED, 0)},
    "a mode that is not fixed": lambda made: {"fixed": rank_of(FAR, 7)},
    "another lack": lambda made: {"unobservable": made["unstable"]},
    "no lack": lambda made: {"anything": made["unstable"]},
    "another kind": lambda made: {"unstable": protocol.encode(joint_controllability(ROUNDED))},
    "a false claim": lambda made: {"unstable": made["unstable"].replace('"rank":1', '"rank":0')},
}


@pytest.mark.parametrize("change", FORGERIES.values(), ids=FORGERIES)
def test_nothing_is_believed_about_a_plant_nearby(
    change: Callable[[dict[str, str]], dict[str, str]],
) -> None:
    with ThreadPoolExecutor(1) as executor:
        work = functools.partial(forged, change)
        [record] = sweep([ROUNDED], JOINT, executor=executor, work=work)
    assert record.error is not None and record.error["status"] == 70 and not record.nearby
    assert change(decide(Job("x", system_text(ROUNDED).encode(), tuple(JOINT)))["nearby"])


def test_what_the_plant_itself_lacks_is_not_said_of_one_nearby() -> None:
    def lie(job: Job) -> Outcome:
        other = Job("other", system_text(ROUNDED).encode(), job.questions)
        return decide(job) | {"nearby": decide(other)["nearby"]}

    lacking = MultiChannelSystem(
        [["-0.3", "0.7"], ["0.3", "-0.7"]], [[["0.1"], ["-0.1"]]], [[[1, 0]]]
    )
    with ThreadPoolExecutor(1) as executor:
        [record] = sweep([lacking], JOINT, executor=executor, work=lie)
    assert record.error is not None and record.error["status"] == 70
