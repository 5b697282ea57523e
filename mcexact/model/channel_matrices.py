"""The matrices B_i or C_i of all channels, by position or by name."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, SupportsIndex, TypeVar, overload

from mcexact import shown
from mcexact.arguments import told
from mcexact.errors import UsageError
from mcexact.model.matrix_entry import Shaped
from mcexact.model.names import nearest, quoted

M = TypeVar("M", bound=Shaped)


def position(name: str, names: Sequence[str]) -> int:
    """Return the position of a channel.

    Raises
    ------
    UsageError
        If no channel has this name.
    """
    if not isinstance(name, str) or name not in names:
        raise UsageError(
            f"there is no channel {told(name)}{nearest(str(name), names)}; "
            f"the channels are {', '.join(map(quoted, names))}"
        )
    return names.index(name)


class ChannelMatrices(tuple[M, ...]):
    """One matrix for each channel: ``B[0]``, ``B["pump"]`` and ``B(0)`` are the same.

    Parameters
    ----------
    matrices : iterable of matrices
    names : tuple of str
        The channels, in order.

    Examples
    --------
    >>> from mcexact.exact.matrix import Matrix
    >>> B = ChannelMatrices([Matrix.identity(1), Matrix.zeros(1, 2)], ("pump", "valve"))
    >>> B["valve"].shape, B[1] == B(1), len(B)
    ((1, 2), True, 2)
    """

    names: tuple[str, ...]

    def __new__(cls, matrices: Iterable[M], names: tuple[str, ...]) -> ChannelMatrices[M]:
        made = super().__new__(cls, matrices)
        made.names = names
        return made

    def __getnewargs__(self) -> tuple[Any, ...]:
        return tuple(self), self.names

    @overload
    def __getitem__(self, channel: SupportsIndex | str) -> M: ...

    @overload
    def __getitem__(self, channel: slice) -> tuple[M, ...]: ...

    def __getitem__(self, channel: Any) -> Any:
        """Return the matrix of a channel, which is given by its position from 0, or its name."""
        if isinstance(channel, str):
            channel = position(channel, self.names)
        return super().__getitem__(channel)

    def __call__(self, channel: int | str) -> M:
        """Return the matrix of a channel."""
        return super().__getitem__(channel) if type(channel) is int else self[channel]

    def __repr__(self) -> str:
        whole = super().__repr__()
        if len(whole) <= shown.LINE:
            return whole
        sizes = ", ".join(f"{each.shape[0]} × {each.shape[1]}" for each in self[:8])
        return f"<matrices of {len(self)} channels: {sizes}{', …' if len(self) > 8 else ''}>"

    def _repr_html_(self) -> str:
        return shown.framed(shown.grid(["channel", ""], zip(self.names, self, strict=True)))
