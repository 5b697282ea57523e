"""The tables of questions about a system, from which names of answers, options and files derive.

A plant of numbers, a plant with one parameter and a plant with several have a table each, which
`questions_about` returns.  The tables for parameters have those questions of `QUESTIONS` that are
decided for all values.  What differs is data of the questions: the function that decides, the
answers that it uses, whether the question is asked by default, and the limit beyond which it is
left out since it would take very long.

A question names its function by a string, because every command has options for questions, and the
modules of all functions take longer to import than most commands run.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from types import MappingProxyType
from typing import Any

# Limits: why a question is left out, unless it is named, as it would take very long.

_MOST_STATES, _MOST_CHANNELS = 10, 20
"""The states of a plant with several parameters, and the channels of one with any, by default."""
_MOST_DEGREE = 60
"""The degree of minors up to which indices are asked by default: a minute on one processor."""


def _left_out_with_numbers(question: Question, system: Any) -> str:
    """The limit for numbers: dense matrices of many states."""
    if question.most and system.n > question.most and not (question.sparse and system.A.is_sparse):
        return f"more than {question.most} states, of which it needs dense matrices"
    return ""


def _left_out_with_parameters(question: Question, plant: Any) -> str:
    """The limit for parameters: states of several, pairs of channels, and degrees of minors."""
    if len(plant.parameters) > 1 and plant.n > _MOST_STATES:
        return f"more than {_MOST_STATES} states with several parameters"
    if question.pairs and plant.m > _MOST_CHANNELS:
        return f"more than {_MOST_CHANNELS} channels, with a certificate for every two"
    if (
        question.ports
        and (degree := _degree_of_minors(plant, question.width(plant))) > _MOST_DEGREE
    ):
        return f"ranks of polynomials of degrees up to about {degree}"
    return ""


def _degree_of_minors(plant: Any, width: int) -> int:
    """About the degree of minors of [B, A B, …]: blocks times rows or columns with letters."""
    degrees = [[_degree(entry) for entry in row] for row in plant.A.rows]
    lines = min(sum(map(any, degrees)), sum(map(any, zip(*degrees, strict=True))))
    n: int = plant.n
    return lines * max(map(max, degrees), default=0) * -(-n // max(width, 1))


def _degree(entry: Any) -> int:
    return max(int(entry.numerator.total_degree()), int(entry.denominator.total_degree()), 0)


# Questions, and the table for numbers.

SHARES = {"outputs+states": "outputs_states", "states": "states"}
"""The form of each way of sharing in the name of a question."""


@dataclass(frozen=True)
class Question:
    """A question: the function that decides it, its subject, and when it is asked.

    Attributes
    ----------
    home : str
        Module of `mcexact.analysis` and function, separated by a colon.
    help : str
        A clause that says what is decided.
    about : {"system", "plant", "linked", "shared", "minimal", "quotient", "lifted", "held"}
        What is asked about.  "plant" is the plant, "linked" the plant with the outputs that agents
        receive over the graph, "shared" with those of all agents from which a path leads to them,
        and "system" the one or the other, as the caller chooses what agents
        feed back.  "minimal" is a minimal realization of "system", and "quotient" has the
        channels of each strong component of its transfer graph merged.  "lifted" and "held" are the
        plant with sub-states shared over links with delays, "held" with sub-states that are shared
        alone, and held for the delays.
    needs : {"", "neighbors", "uncertainty", "subset", "channel", "channels", "information"}
        What the question needs: a neighbor graph, radii of entries or ranges of parameters, a set
        of channels, a channel, or what agents feed back, which is always known.  The last four
        values name an argument of the function; ``channels`` is a list of one channel.
    by_default : bool
        Whether it is asked by default; NP-hard and slow questions are not.
    option : str
        The name of the option of `mcexact analyze` that asks it, with the help of its first
        question.
    ports : {"", "inputs", "outputs"}
        If not empty, it is about ranks of a Krylov sequence of these.  With parameters it is asked
        by default only up to a degree of the minors of this sequence.
    most : int
        If not 0, it is asked by default only of at most so many states without parameters, which
        take about a minute on one processor.
    sparse : bool
        Whether ``most`` is not for plants of sparse matrices.
    pairs : bool
        Whether the evidence for all values of parameters has a certificate for every two channels.
    keywords : mapping
        Further keyword arguments of the function.
    reuses : mapping
        Keyword arguments that take the answer to another question about the same system.
    shares : mapping
        Keyword arguments that take the answer to another question only if that is asked as well:
        they save work, and the answer does not depend on them.
    kind : str
        The kind of the certificate, if it is not the name of the question.
    dual : bool
        Whether the certificate is about the dual system.
    for_all_values : bool
        Whether it is decided for all values of parameters as well.
    limit : callable
        It takes the question and a system, and returns why the question would take very long about
        it; empty if it would not.
    """

    home: str
    help: str
    about: str = "system"
    needs: str = ""
    by_default: bool = True
    option: str = ""
    ports: str = ""
    most: int = 0
    sparse: bool = False
    pairs: bool = False
    keywords: Mapping[str, Any] = field(default_factory=dict)
    reuses: Mapping[str, str] = field(default_factory=dict)
    shares: Mapping[str, str] = field(default_factory=dict)
    kind: str = ""
    dual: bool = False
    for_all_values: bool = False
    limit: Callable[[Question, Any], str] = _left_out_with_numbers

    @property
    def module(self) -> str:
        """The module of the function that decides it."""
        return self.home.partition(":")[0]

    @property
    def function(self) -> str:
        """The name of the function that decides it."""
        return self.home.partition(":")[2]

    def decide(self, *arguments: Any, **keywords: Any) -> Any:
        """Call the function that decides it."""
        module = importlib.import_module(f"mcexact.analysis.{self.module}")
        return getattr(module, self.function)(*arguments, **self.keywords, **keywords)

    def width(self, system: Any) -> int:
        """The number of the inputs or outputs that the evidence depends on."""
        return sum(p if self.ports == "inputs" else q for p, q in system.sizes)

    def reason_to_leave_out(self, system: Any) -> str:
        """Why it is not asked by default about a system; empty if it is.

        Parameters
        ----------
        system : MultiChannelSystem or ParametricSystem
        """
        return self.limit(self, system)


def _joint(
    about: str = "system", needs: str = "", option: str = "", spectrum: str = ""
) -> dict[str, Question]:
    """The questions on controllability and observability of all channels or of one channel."""
    return {
        f"{what}ability": Question(
            f"controllability:joint_{what}ability",
            f"which modes the channels {verb}",
            about=about,
            needs=needs,
            by_default=not option,
            option=option,
            shares={"spectrum": spectrum} if spectrum else {},
            kind="controllability",
            dual=what == "observ",
            pairs=about == "system",
            for_all_values=about == "system",
        )
        for what, verb in (("controll", "control"), ("observ", "observe"))
    }


# The question, the kind of its certificate, its option, what is decided.
_SHARING = (
    ("shared_dimension_bound", "deficiency", "", "dimensions that suffice"),
    (
        "minimal_shared_dimensions",
        "shared_dimensions",
        "minimal",
        "the least dimensions that agents must share, in all and if all share equally many",
    ),
    (
        "common_dimension",
        "common_dimension",
        "minimal",
        "the least dimension that agents must share if all share equally many",
    ),
)
_DENSE = 1500
"""The states of a sparse plant for which exact elimination takes a minute."""
_MOST_OF_MINIMAL = 500
"""The states up to which joint fixed modes are told from others by default."""
_MOST_OF_QUOTIENT = 100
"""The states up to which quotient fixed modes are decided by default: it takes as long again, to
decide and to check, as the fixed modes of the plant."""
_JOINT, _ALONE = _joint(spectrum="fixed_spectrum"), _joint(needs="channels")
_SPECTRUM = {"spectrum": "fixed_spectrum"}

QUESTIONS: Mapping[str, Question] = MappingProxyType(
    {
        "fixed_spectrum": Question(
            "fixed_modes:fixed_spectrum",
            "which modes no linear time-invariant decentralized control moves",
            for_all_values=True,
        ),
        "linked_fixed_spectrum": Question(
            "fixed_modes:fixed_spectrum",
            "which modes stay fixed where each agent also feeds back the outputs of its neighbors; "
            "by default if some mode is fixed without these",
            about="linked",
            needs="neighbors",
            by_default=False,
            kind="fixed_spectrum",
        ),
        "shared_fixed_spectrum": Question(
            "fixed_modes:fixed_spectrum",
            "which modes stay fixed however much agents share over the graph; by default if some "
            "mode is fixed and the graph is not strongly connected",
            about="shared",
            needs="neighbors",
            by_default=False,
            kind="fixed_spectrum",
        ),
        "minimal_fixed_spectrum": Question(
            "fixed_modes:fixed_spectrum",
            "which modes are fixed without what all channels together do not control or do not "
            "observe; by default if there is such a part",
            about="minimal",
            by_default=False,
            most=_MOST_OF_MINIMAL,
            kind="fixed_spectrum",
        ),
        "quotient_fixed_spectrum": Question(
            "fixed_modes:fixed_spectrum",
            "which modes no causal decentralized control moves, even if it varies in time or is "
            "nonlinear; by default if some channels lack control and others lack sight of a mode",
            about="quotient",
            by_default=False,
            most=_MOST_OF_QUOTIENT,
            kind="fixed_spectrum",
        ),
        "structural_fixed_modes": Question(
            "patterns:structural_fixed_modes",
            "which modes are fixed for all numbers at the places of the nonzero entries; by "
            "default if some mode is fixed",
            about="plant",
            needs="information",
            by_default=False,
            most=_MOST_OF_MINIMAL,
        ),
        "failures": Question(
            "failures:failures",
            "which modes are fixed after each single failure of an agent, an actuator or a sensor, "
            "and with --information outputs of a link",
            about="plant",
            needs="information",
            by_default=False,
            option="failures",
            reuses=_SPECTRUM,
            kind="fixed_spectrum",
        ),
        "fewest_failures": Question(
            "failures:fewest_failures",
            "the fewest agents after whose failure a further mode is fixed, or one that is not "
            "stable, and the fewest actuators and sensors where agents have several; with "
            "--information outputs those of links, too",
            about="plant",
            needs="information",
            by_default=False,
            option="fewest-failures",
            reuses=_SPECTRUM,
            kind="fixed_spectrum",
        ),
        "completeness": Question(
            "fixed_modes:completeness",
            "whether any single channel can control and observe everything",
            reuses=_SPECTRUM,
            for_all_values=True,
        ),
        **{f"joint_{name}": question for name, question in _JOINT.items()},
        "controllability_indices": Question(
            "controllability:controllability_indices",
            "the controllability indices",
            ports="inputs",
            most=_DENSE,
            sparse=True,
            for_all_values=True,
        ),
        "observability_indices": Question(
            "controllability:observability_indices",
            "the observability indices",
            ports="outputs",
            most=_DENSE,
            sparse=True,
            kind="controllability_indices",
            dual=True,
            for_all_values=True,
        ),
        "transfer_graph": Question(
            "structure:transfer_graph",
            "which channels' inputs affect which outputs",
            pairs=True,
            for_all_values=True,
        ),
        "assignability": Question(
            "fixed_modes:assignability",
            "the parts into which the closed-loop spectrum splits",
            reuses={"graph": "transfer_graph"},
            most=_DENSE,
            sparse=True,
        ),
        "setpoint": Question(
            "structure:setpoint_solvability",
            "whether every output can be held at any value",
            about="plant",
            most=_DENSE,
            sparse=True,
            for_all_values=True,
        ),
        "complementary_subsystem": Question(
            "structure:complementary_subsystem",
            "rank, zeros and remnant polynomial of the pencil of a set of channels",
            needs="subset",
        ),
        "spectrum_of_A": Question(
            "stability:open_loop_spectrum",
            "the modes of the plant",
            by_default=False,
            kind="closed_loop_spectrum",
        ),
        "pencil_rank": Question(
            "fixed_modes:pencil_ranks",
            "the rank of the pencil of a set of channels at every mode",
            needs="subset",
            reuses={"spectrum": "spectrum_of_A"},
        ),
        **{f"channel_{name}": question for name, question in _ALONE.items()},
        **{
            f"channel_gains_{want}": Question(
                "single_channel:single_channel_gains",
                f"whether gains make one channel {power}",
                needs="channel",
                keywords={"want": want},
                kind="single_channel_gains",
            )
            for want, power in (
                ("controllable", "control everything"),
                ("observable", "observe everything"),
                ("both", "control and observe everything"),
            )
        },
        "every_channel": Question(
            "single_channel:single_channel_gains",
            "gains with which every channel controls and observes the whole plant",
            by_default=False,
            option="every-channel",
            kind="single_channel_gains",
        ),
        "neighbor_graph": Question(
            "sharing:neighbor_graph",
            "whether the neighbor graph is strongly connected",
            about="plant",
            needs="neighbors",
        ),
        "sharing_gap": Question(
            "sharing_gap:sharing_gap",
            "by which factors the bounds on what agents share can exceed the least, over the graph",
            about="plant",
            needs="neighbors",
            by_default=False,
            option="minimal",
        ),
        **{
            f"{name}_{stem}": Question(
                f"sharing:{name}",
                help,
                about="plant",
                needs="neighbors",
                by_default=not option,
                option=option,
                keywords={"share": share},
                kind=kind,
            )
            for name, kind, option, help in _SHARING
            for share, stem in SHARES.items()
        },
        **{
            name: Question(
                f"boxes.members:{name}",
                f"whether {quality} for every plant within the radii of the entries, or the ranges",
                needs="uncertainty",
                for_all_values=True,
                reuses={"spectrum": "fixed_spectrum"} if kind == "box_fixed" else {},
                shares=(
                    {"nothing_fixed": "box_fixed_modes"} if name == "box_stabilizability" else {}
                ),
                kind=kind,
                dual=name == "box_observability",
            )
            for name, kind, quality in (
                ("box_fixed_modes", "box_fixed", "no mode is fixed"),
                ("box_stabilizability", "box_fixed", "a controller of its own stabilizes,"),
                ("box_controllability", "box_controllable", "the channels control every mode,"),
                ("box_observability", "box_controllable", "the channels observe every mode,"),
            )
        },
        "box_setpoints": Question(
            "boxes.members:box_setpoints",
            "whether a controller of its own holds every plant within the radii at any constant "
            "set-points",
            about="plant",
            needs="uncertainty",
            reuses={"solvability": "setpoint"},
            kind="box_fixed",
        ),
        "minimal_communication": Question(
            "sharing:minimal_communication",
            "the fewest links over which sending outputs leaves no mode fixed",
            about="plant",
            by_default=False,
            option="links",
            kind="communication",
        ),
        **{
            f"{network}_{name}": question
            for network in ("lifted", "held")
            for name, question in {
                "fixed_spectrum": Question(
                    "fixed_modes:fixed_spectrum",
                    "which modes are fixed with the delays of the neighbor graph, lifted and held",
                    about=network,
                    needs="neighbors",
                    by_default=False,
                    option="delayed",
                    kind="fixed_spectrum",
                ),
                **{
                    f"joint_{what}": each
                    for what, each in _joint(
                        network, "neighbors", "delayed", f"{network}_fixed_spectrum"
                    ).items()
                },
            }.items()
        },
    }
)
"""All questions by name.

The answer has the same name in Python and in JSON, and so has the file of its certificate, with
``.json``; several answers to one question are numbered.
"""


# The tables for parameters.

_WITHIN_RANGES = ("box_fixed_modes", "box_stabilizability")
"""What is asked by default about all values within the ranges of several parameters.

With one parameter the exact answers say what holds in its range.
"""


def _for_all_values(name: str, question: Question, *, several: bool) -> Question:
    """Return a question as it is asked about a plant with one parameter, or with several."""
    asked = replace(question, limit=_left_out_with_parameters, reuses={}, shares={})
    if name == "completeness":
        answers = {"spectrum": "fixed_spectrum", "graph": "transfer_graph"}
        return replace(
            asked, home="parameters.hypersurfaces:parametric_completeness", reuses=answers
        )
    if question.needs == "uncertainty":
        return replace(asked, by_default=several and name in _WITHIN_RANGES)
    if several:
        home = "parameters.hypersurfaces:exceptional_hypersurfaces"
        return replace(asked, home=home, keywords={"question": name})
    return asked


@cache
def _with_parameters(*, several: bool) -> Mapping[str, Question]:
    """The table for one parameter or for several, made when it is first used."""
    return MappingProxyType(
        {
            name: _for_all_values(name, question, several=several)
            for name, question in QUESTIONS.items()
            if question.for_all_values
        }
    )


def questions_about(parameters: Sequence[str]) -> Mapping[str, Question]:
    """Return the table of questions about a plant with some parameters, or with none."""
    return _with_parameters(several=len(parameters) > 1) if parameters else QUESTIONS


def asked_by(*options: str) -> list[str]:
    """The names of the questions that options of `mcexact analyze` ask."""
    return [name for name, question in QUESTIONS.items() if question.option in options]
