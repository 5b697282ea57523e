"""The table of questions about a system, from which names of answers, options and files derive."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

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
    about : {"system", "plant", "linked", "lifted", "held"}
        What is asked about.  "plant" is the plant, "linked" the plant with the outputs that agents
        receive over the graph, and "system" the one or the other, as the caller chooses what agents
        feed back.  "lifted" and "held" are the plant with sub-states shared over links with delays,
        "held" with sub-states that are shared alone, and held for the delays.
    needs : {"", "neighbors", "uncertainty", "subset", "channel", "channels"}
        What the question needs: a neighbor graph, radii of entries, a set of channels or a channel.
        The last three values name the function's second argument; ``channels`` is a list of one
        channel.
    unbidden : bool
        Whether it is asked by default; NP-hard and slow questions are not.
    option : str
        The name of the option of `mcexact analyze` that asks it, with the help of its first
        question.
    ports : {"", "inputs", "outputs"}
        If not empty, it is asked by default only if n² ≤ 10⁴ and n³ ≤ 2·10⁶ times the number of
        these, since the evidence is a Krylov sequence, which is longer with fewer of them.
    most : int
        If not 0, it is asked by default only of at most so many states, which take about a minute
        on one processor.
    given : mapping
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
    """

    home: str
    help: str
    about: str = "system"
    needs: str = ""
    unbidden: bool = True
    option: str = ""
    ports: str = ""
    most: int = 0
    given: Mapping[str, Any] = field(default_factory=dict)
    reuses: Mapping[str, str] = field(default_factory=dict)
    shares: Mapping[str, str] = field(default_factory=dict)
    kind: str = ""
    dual: bool = False
    for_all_values: bool = False

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
        return getattr(module, self.function)(*arguments, **self.given, **keywords)

    def reason_to_leave_out(self, n: int, ports: Mapping[str, int]) -> str:
        """Why it is not asked by default about n states with so many ports; empty if it is."""
        if self.most and n > self.most:
            return f"more than {self.most} states, of which it needs dense matrices"
        width = max(ports[self.ports], 1) if self.ports else n
        if self.ports and (n**2 > 10**4 * width or n**3 > 2 * 10**6 * width):
            return f"{n} states for {width} {self.ports}, which make very long evidence"
        return ""


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
            unbidden=not option,
            option=option,
            shares={"spectrum": spectrum} if spectrum else {},
            kind="controllability",
            dual=what == "observ",
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
            unbidden=False,
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
            for_all_values=True,
        ),
        "observability_indices": Question(
            "controllability:observability_indices",
            "the observability indices",
            ports="outputs",
            kind="controllability_indices",
            dual=True,
            for_all_values=True,
        ),
        "transfer_graph": Question(
            "structure:transfer_graph",
            "which channels' inputs affect which outputs",
            for_all_values=True,
        ),
        "assignability": Question(
            "fixed_modes:assignability",
            "the parts into which the closed-loop spectrum splits",
            reuses={"graph": "transfer_graph"},
            most=_DENSE,
        ),
        "setpoint": Question(
            "structure:setpoint_solvability",
            "whether every output can be held at any value",
            about="plant",
            most=_DENSE,
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
            unbidden=False,
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
                f"whether gains make one channel {said}",
                needs="channel",
                given={"want": want},
                kind="single_channel_gains",
            )
            for want, said in (
                ("controllable", "control everything"),
                ("observable", "observe everything"),
                ("both", "control and observe everything"),
            )
        },
        "every_channel": Question(
            "single_channel:single_channel_gains",
            "gains with which every channel controls and observes the whole plant",
            unbidden=False,
            option="every-channel",
            kind="single_channel_gains",
        ),
        "neighbor_graph": Question(
            "sharing:neighbor_graph",
            "whether the neighbor graph is strongly connected",
            about="plant",
            needs="neighbors",
        ),
        **{
            f"{name}_{stem}": Question(
                f"sharing:{name}",
                help,
                about="plant",
                needs="neighbors",
                unbidden=not option,
                option=option,
                given={"share": share},
                kind=kind,
            )
            for name, kind, option, help in _SHARING
            for share, stem in SHARES.items()
        },
        **{
            name: Question(
                f"boxes.members:{name}",
                f"whether {said} for every plant within the radii of the entries, or the ranges",
                needs="uncertainty",
                for_all_values=True,
                reuses={"spectrum": "fixed_spectrum"} if kind == "box_fixed" else {},
                kind=kind,
                dual=name == "box_observability",
            )
            for name, kind, said in (
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
            unbidden=False,
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
                    unbidden=False,
                    option="delayed",
                    kind="fixed_spectrum",
                ),
                **{
                    f"joint_{what}": found
                    for what, found in _joint(
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


def asked_by(*options: str) -> list[str]:
    """The names of the questions that options of `mcexact analyze` ask."""
    return [name for name, question in QUESTIONS.items() if question.option in options]
