"""Accounts: answers about a system, the sentences that follow from them, and their certificates."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from html import escape
from typing import Any

from mcexact.answer import codec
from mcexact.answer.members import leading
from mcexact.answer.sentence import MANIFEST, Given, Sentences, manifest
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import canonical, write_text
from mcexact.shown import Shown

FORMAT = "mcexact-analysis/1"
_ANSWER = ("answer", "answer.mode")
_PLAIN = ("title", *_ANSWER, "table")


@dataclass(frozen=True, repr=False)
class Account(Shown):
    """Answers about one plant by name, with the sentences that follow from them.

    Attributes
    ----------
    answers : mapping
        The answers by name; the name with ``.json`` is that of the certificate's file.
    given : Given
    sentences : Sentences
        The sentences that follow by the rules, each with its place and premises.
    subject : sequence of mapping
        The constructions that lead from the user's plant to the plant of this account.
    open : collection of str
        The questions that were asked and have no answer.
    failing : mapping
        For some of these the exact answer about a plant within the radii that lacks what was asked.
    nearby : collection of str
        The names of answers, as far as there are such, that are about another plant nearby.
    """

    answers: Mapping[str, Any]
    given: Given
    sentences: Sentences
    subject: Sequence[Mapping[str, Any]] = ()
    open: Collection[str] = ()
    failing: Mapping[str, Any] = field(default_factory=dict)
    nearby: Collection[str] = ()

    def __repr__(self) -> str:
        return f"Account({len(self.answers)} answers, {len(self.sentences)} sentences)"

    @cached_property
    def certificates(self) -> dict[str, str]:
        """The text of every certificate, keyed by the name of its file."""
        return {f"{name}.json": codec.encode(answer) for name, answer in self.answers.items()}

    def manifest(self) -> dict[str, Any]:
        """Return the sentences with their premises, and the digests of the certificates."""
        return self._manifest(self.certificates)

    def _manifest(self, texts: Mapping[str, str]) -> dict[str, Any]:
        near = [f"{name}.json" for name in sorted(self.nearby) if name in self.answers]
        return manifest(self.sentences, texts, self.subject, near)

    def files(self, *, system_by_digest: bool = False) -> dict[str, str]:
        """Return the certificates and the manifest, keyed by the names of their files.

        Parameters
        ----------
        system_by_digest : bool
            Whether certificates name the plant by its digest alone, as in `codec.encode`; those
            about a box around it, of which there is no file, contain it.
        """
        texts = self.certificates
        if system_by_digest:
            own = self.given.system.digest()
            texts = {
                f"{name}.json": codec.encode(
                    answer, system_by_digest=answer.about.plant.digest() == own
                )
                for name, answer in self.answers.items()
            }
        return texts | {MANIFEST: canonical(self._manifest(texts)) + "\n"}

    def save(self, folder: str | os.PathLike[str], *, system_by_digest: bool = False) -> None:
        """Write the certificates and the manifest into a folder, which is made if it is missing.

        Parameters
        ----------
        folder : path
        system_by_digest : bool
            Whether certificates name the plant by its digest alone, as in `save_certificate`.

        Raises
        ------
        NotWritten
            If a file cannot be written.
        OSError
            If the folder cannot be made.
        """
        os.makedirs(folder, exist_ok=True)
        for name, text in self.files(system_by_digest=system_by_digest).items():
            write_text(os.path.join(folder, name), text)

    def as_json(self, **more: Any) -> dict[str, Any]:
        """Return plain data with an entry for each answer, keyed by its name."""
        system = self.given.system
        return {
            "format": FORMAT,
            "system": {
                "name": system.name,
                "n": system.n,
                "m": system.m,
                "time": system.time,
                "channels": list(system.names),
            },
            **more,
            "answer": [str(each) for each in self.sentences.at("answer", "answer.mode")],
            "sentences": [
                {"text": each.line, "rule": each.template.key, "theorem": each.template.theorem}
                for each in self.sentences
            ],
            **{
                name: answer.to_dict() | {"certificate": f"{name}.json"}
                for name, answer in self.answers.items()
            },
        }

    @cached_property
    def leading(self) -> tuple[str, ...]:
        """What is said first of every plant within the radii, if there are such plants."""
        system = self.given.system
        if not isinstance(system, MultiChannelSystem):
            return ()
        return leading(system.plant, self.answers, self.open, self.failing)

    def explain(self) -> str:
        """Say in plain words what was found, one sentence a line."""
        return "\n".join([*self.leading, *(each.line for each in self.sentences.at(*_PLAIN))])

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the sentences of the answer, and the labels and texts of the table."""
        yield from (("", each) for each in self.leading)
        yield from (("", str(each)) for each in self.sentences.at(*_ANSWER))
        yield from ((each.cells[0], str(each)) for each in self.sentences.at("table"))

    def _html(self) -> str:
        """Return the sentences and the table in HTML, each entry with its reason."""
        said = "".join(f"<li>{escape(each)}</li>" for each in self.leading)
        said += "".join(
            f'<li title="{escape(_reason(each))}">{escape(each)}</li>'
            for each in self.sentences.at(*_ANSWER)
        )
        rows = "".join(
            f'<tr title="{escape(_reason(each))}"><th>{escape(each.cells[0])}</th>'
            f"<td>{escape(each)}</td></tr>"
            for each in self.sentences.at("table")
        )
        title = "".join(self.sentences.at("title"))
        over = f"<caption>{escape(title)}</caption>" if title else ""
        return (f'<ul class="said">{said}</ul>' if said else "") + f"<table>{over}{rows}</table>"


def _reason(sentence: Any) -> str:
    """The theorem and the premises of a sentence, without their values."""
    places = [f"{file}#{pointer}" for file, pointer, _ in sentence.because]
    return "; ".join(filter(None, [sentence.template.theorem, *places]))


class ShownByAccount(Shown):
    """A result that is shown as its account is: its sentences, or without these its table."""

    @property
    def account(self) -> Account:
        """The answers, with the sentences that follow from them."""
        raise NotImplementedError

    def explain(self) -> str:
        """Say the sentences of the account in plain words, one a line."""
        return self.account.explain()

    def _labeled(self) -> Iterable[tuple[str, Any]]:
        return self.account._labeled()

    def _html(self) -> str:
        return self.account._html()
