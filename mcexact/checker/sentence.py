"""Rules for sentences: premises, the roles that premises play, and the table of rules."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from .reading import require

Path = tuple[str, ...]
"""The names of the constructions that lead from the manifest's system to a subject."""

SYSTEM: tuple[Path, ...] = ((), ("augmented_outputs",))
"""What agents receive: their own outputs, or also those of their neighbors."""
DUAL = tuple((*path, "dual") for path in SYSTEM)
PLANT, HEARD = SYSTEM[:1], SYSTEM[1:]


@dataclass(frozen=True)
class Premise:
    """A certificate that was found VALID.

    Attributes
    ----------
    file : str
    document : dict
        The whole certificate, whose witness has been verified as well.
    plant, system, meant : System or ParametricSystem
        The plant, the subject that was built from it, and the system that the manifest is about.
    statement : str
        The statement that the checker verified, without the sizes of the system.
    path : tuple of str, or None
        The constructions of the subject; None if they do not begin at the manifest's system.
    pointers : tuple of str
        The pointers of a sentence into this certificate.
    nearby : bool
        Whether the plant is another one than that of the manifest: then no rule but those about
        such plants takes it.
    """

    file: str
    document: dict[str, Any]
    plant: Any
    system: Any
    meant: Any
    statement: str
    path: Path | None
    pointers: tuple[str, ...] = ()
    nearby: bool = False

    def __getitem__(self, key: str) -> Any:
        return self.document["claim"][key]

    @property
    def kind(self) -> str:
        """The kind of the certificate."""
        return str(self.document["kind"])

    @property
    def witness(self) -> Any:
        """The evidence, verified."""
        return self.document["witness"]

    @property
    def about(self) -> str:
        """The subject in words, with which a sentence begins."""
        return f"For {self.system.words}"

    def expect(self, holds: bool, message: str) -> None:
        """Stop unless the claims are as the sentence needs them."""
        require(holds, "claim", self.file, message)

    def cited(self, part: str, key: str) -> list[Any]:
        """The members of a list to which the sentence points; all of them if it points to none."""
        paths = [pointer.split("/")[1:] for pointer in self.pointers]
        numbers = {int(path[2]) for path in paths if path[:2] == [part, key] and path[2:]}
        members = enumerate(self.document[part][key])
        return [member for k, member in members if k in numbers or not numbers]


@dataclass(frozen=True)
class Role:
    """The requirements on a premise: one of these kinds, with one of these subjects.

    With ``many``, all fitting premises, at least one, are taken as a list; with ``nearby`` those
    about another plant than that of the manifest, and no others.
    """

    kinds: Path
    paths: tuple[Path, ...] = SYSTEM
    many: bool = False
    nearby: bool = False

    def fits(self, premise: Premise, heard: bool) -> bool:
        """Whether a premise can play the role, for agents with or without their neighbors' outputs.

        All premises with such a role must have the same information structure.
        """
        ways = self.paths
        if ways in (SYSTEM, DUAL):
            ways = ways[heard : heard + 1]
        right = premise.kind in self.kinds and premise.path in ways
        return right and premise.nearby == self.nearby

    def words(self) -> str:
        """The role, for a message."""
        ways = " or ".join("+".join(path) or "the plant" for path in self.paths)
        whose = " of a plant that is listed as nearby" if self.nearby else ""
        return f"a premise of the kind {' or '.join(self.kinds)}, about {ways}{whose}"


@dataclass(frozen=True)
class Rule:
    """The premises that imply a sentence, the theorem, and the implied statement in words.

    ``say`` takes the premises in the order of the roles, and stops if their claims do not imply the
    sentence. Without roles it takes all premises, those of the sentence first, and repeats what was
    given.  ``claims`` is false of a remark, which says nothing that could be true or false of the
    system: its verdict is REMARK and never IMPLIED.
    """

    theorem: str
    roles: tuple[Role, ...]
    say: Callable[..., str]
    claims: bool = True

    def implied(self, cited: list[Premise], known: list[Premise]) -> str:
        """The statement that the premises imply.

        Raises
        ------
        Refused
            If a premise is missing, or they do not imply the sentence.
        """
        if not self.roles:
            return self.say([each for each in [*cited, *known] if not each.nearby])
        casts = [list(self._cast(cited, heard)) for heard in (False, True)]
        found = max(casts, key=len)
        if len(found) < len(self.roles):
            wanted = self.roles[len(found)].words()
            require(False, "premise", "because", f"expected {wanted}")
        return self.say(*found)

    def _cast(self, cited: list[Premise], heard: bool) -> Iterator[Any]:
        """The premise for each role, up to the first role without a premise."""
        for role in self.roles:
            able = [premise for premise in cited if role.fits(premise, heard)]
            if not able:
                return
            yield able if role.many else able[0]


RULES: dict[str, Rule] = {}
"""The rule of each sentence, by the key that the manifest names."""

Say = Callable[..., str]
Holds = Callable[[Premise], object]


def rule(keys: str, *roles: Role, theorem: str = "") -> Callable[[Say], Say]:
    """Enter a rule under these keys, with blanks between them."""

    def enter(say: Say) -> Say:
        RULES.update({key: Rule(theorem, roles, say) for key in keys.split()})
        return say

    return enter


def remark(keys: str) -> None:
    """Enter rules of sentences that claim nothing: titles, and what is not decided or proved."""

    def enter(key: str) -> None:
        def say(known: list[Premise]) -> str:
            return f"For {known[0].meant.words}: the sentence {key} claims nothing"

        RULES[key] = Rule("", (), say, claims=False)

    for each in keys.split():
        enter(each)


def repeated(premise: Premise) -> str:
    """The certificate's claim, as it was verified."""
    return premise.statement


def restate(keys: str, role: Role, holds: Holds, theorem: str = "", words: Say = repeated) -> None:
    """Enter a rule with one premise, which by default repeats the certificate's claim."""

    def say(premise: Premise) -> str:
        premise.expect(bool(holds(premise)), "the claim is different")
        return words(premise)

    rule(keys, role, theorem=theorem)(say)


def either(yes: str, no: str, role: Role, holds: Holds) -> None:
    """Enter a rule that repeats what holds, and one that repeats that it does not."""
    restate(yes, role, holds)
    restate(no, role, lambda premise: not holds(premise))
