"""Plants at the samples: inputs are held, and perhaps applied some steps late.

Between samples the inputs of a plant in continuous time do not change, so that at the samples it is
a plant in discrete time.  Its matrices are values of the exponential, which are irrational:
`sampled_system` has rational ones near them, which certificates about one plant are about, and
`sampled_within` also the radii within which the exact ones are, for every plant of a box.  What is
proved for boxes is therefore about the exact exponential, of the plant and of every member.

`sampled_system` records the construction, so that certificates are about the plant in continuous
time, and the checker samples it itself.  `c2d` gives the same plant as a plant of its own, for a
file.  `tustin` makes a controller in continuous time one for the samples.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from mcexact.derived.constructions import require_size
from mcexact.errors import InputError, UsageError
from mcexact.exact.linear_algebra import inverse
from mcexact.exact.matrix import Matrix, as_requested, hstack, vstack
from mcexact.exact.rational import Entry, rational_text, three_digits, written
from mcexact.exact.roots import is_discrete
from mcexact.exact.sampling import held_exponential
from mcexact.model.box import Box
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.limits import limits_document
from mcexact.model.radii import Radii
from mcexact.model.regulated import selection_document
from mcexact.model.sizes import TypicalSizes
from mcexact.model.system import MultiChannelSystem

DECIMALS = 12
_MOST_DECIMALS = 1000


def sampled_system(
    system: MultiChannelSystem, step: Entry, late: int = 0, *, decimals: int = DECIMALS
) -> MultiChannelSystem:
    """Sample a plant whose inputs are held between samples, and applied some steps late.

    Parameters
    ----------
    system : MultiChannelSystem
        In continuous time.
    step : rational or float
        The time h between samples; 0.1 stands for 1/10.
    late : int
        d, the number of steps from an output to the input that is computed from it: 1 if agents
        measure at a sample, and set their inputs at the next one.
    decimals : int
        The number of decimals of A_h and B_h.

    Returns
    -------
    MultiChannelSystem
        In discrete time, with the channels and the neighbor graph of the plant.

    Raises
    ------
    UsageError
        If the system is in discrete time, the step is not above 0, ``late`` is no integer from 0
        on, or the number of decimals is not from 0 to 1000.
    LimitReached
        If the step is too long for the fastest rates of the plant, or there would be more than
        20000 states.

    Notes
    -----
    Exact, up to the rounding to decimals.  A_h and B_h are those of::

            ⎡ A  B ⎤     ⎡ A_h  B_h ⎤
        exp ⎣ 0  0 ⎦ h = ⎣ 0     I  ⎦

    and the state is (x, v_1, …, v_d), v_1 the inputs that are applied, with

        x(t+1) = A_h x + B_h v_1,   v_k(t+1) = v_{k+1},   v_d(t+1) = u,   y_i = C_i x;

    without delay x(t+1) = A_h x + B_h u.  Certificates about boxes are about the exact matrices of
    every member (`sampled_within`), all others about the rounded ones.

    Examples
    --------
    >>> plant = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    >>> late = sampled_system(plant, "1/10", 1)
    >>> late.A.rows()[0], late.B(0).rows()[2], late.C(0).rows()[0]
    ((Fraction(1, 1), Fraction(1, 10), Fraction(1, 200)), (Fraction(1, 1),), \
(Fraction(1, 1), Fraction(0, 1), Fraction(0, 1)))
    >>> sampled_system(late, "1/10")
    Traceback (most recent call last):
        ...
    mcexact.errors.UsageError: system: the system is in discrete time already
    """
    InputError.require(system, MultiChannelSystem, "system")
    h, late = _checked(system, step, late, decimals)
    M = _held(system)
    center, _ = held_exponential(M, Matrix.zeros(*M.shape), h, decimals)
    A, B, C = _with_registers(system, center, late, 1)
    construction = {
        "construction": "sampled",
        "step": written(h),
        "late": late,
        "decimals": decimals,
    }
    return system.derived(
        A,
        B,
        C,
        construction,
        neighbors=system.neighbors,
        time="discrete",
        sample_time=h,
        regulated=system.regulated,
        limits=system.limits,
        typical_sizes=_sizes_with_registers(system, late),
    )


def sampled_within(
    system: MultiChannelSystem, radii: Radii, step: Entry, late: int, decimals: int
) -> Radii:
    """Return the radii of a sampled system, for all systems within radii of one.

    Parameters
    ----------
    system : MultiChannelSystem
        In continuous time.
    radii : Radii
        Those of its entries.
    step, late, decimals
        As for `sampled_system`.

    Returns
    -------
    Radii
        The exact A_h and B_h of every member are within these of those of `sampled_system`.

    Examples
    --------
    >>> plant = MultiChannelSystem([[-1]], [[[1]]], [[[1]]])
    >>> radii = sampled_within(plant, Box(plant).radii, 1, 0, 3)
    >>> radii.A[0, 0]  # exp(-1) = 0.367879… is sampled as 0.368
    Fraction(121, 1000000)
    """
    h, late = _checked(system, step, late, decimals)
    D = hstack([radii.A, *radii.B])
    return _radii_with_registers(radii, held_exponential(_held(system), D, h, decimals)[1], late)


def c2d(
    system: MultiChannelSystem,
    step: Entry,
    late: int = 0,
    *,
    decimals: int = DECIMALS,
    enclosed: bool = False,
) -> MultiChannelSystem:
    """Sample a plant as `sampled_system` does, and return a plant of its own.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant in continuous time.
    step, late, decimals
        As for `sampled_system`.
    enclosed : bool
        Whether the radii of a plant whose entries are certain are those of rounding: what is
        proved for every plant within them is proved for the exact one.  Radii of an uncertain plant
        are carried over always.

    Returns
    -------
    MultiChannelSystem
        Outputs, names and neighbors stay.  ``source`` states the rounding.  Its radii contain the
        exact samples of every plant within those of the given one.

    Raises
    ------
    UsageError
        If the system is in discrete time or no plant, or as in `sampled_system`.

    Examples
    --------
    >>> plant = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    >>> sampled = c2d(plant, "1/10")
    >>> sampled.A.rows()[0], sampled.B(0).rows()
    ((Fraction(1, 1), Fraction(1, 10)), ((Fraction(1, 200),), (Fraction(1, 10),)))
    >>> print(sampled.source)
    sampled every 1/10 with inputs held; every entry of A and B differs from the exact one by at \
most 0.51e-12
    >>> uncertain = c2d(Box.absolute(plant, A=[[0, 0], ["1/100", 0]]).system, "1/10")
    >>> [float(radius) for radius in uncertain.uncertainty.A.rows()[1]]
    [0.001000016771489, 5.0000419288e-05]
    """
    InputError.require(system, MultiChannelSystem, "system")
    if system.subject:
        raise UsageError("expected a plant, found a derived system", where="system")
    h, late = _checked(system, step, late, decimals)
    M = _held(system)
    center, missed = held_exponential(M, Matrix.zeros(*M.shape), h, decimals)
    radii = None
    if system.uncertainty is not None:
        radii = sampled_within(system, system.uncertainty, h, late, decimals)
    elif enclosed:
        radii = _radii_with_registers(Box(system).radii, missed, late)
    late_by = f" and applied {late} step{'s' * (late > 1)} late" if late else ""
    note = (
        f"sampled every {rational_text(h)} with inputs held{late_by}; every entry of A and B "
        f"differs from the exact one by at most {_largest(missed, decimals)}"
    )
    if system.uncertainty is not None:
        note += "; the radii contain the exact samples of every plant within those of the original"
    A, B, C = _with_registers(system, center, late, 1)
    regulated = system.regulated
    return MultiChannelSystem(
        A,
        B,
        C,
        time="discrete",
        names=system.names,
        neighbors=system.neighbors,
        sample_time=h,
        uncertainty=radii,
        regulated=None if regulated is None else selection_document(regulated, system.names),
        limits=None if system.limits is None else limits_document(system.limits, system.names),
        typical_sizes=_sizes_with_registers(system, late),
        name=system.name,
        source=note if system.source is None else f"{system.source}; {note}",
    )


def _checked(
    system: MultiChannelSystem, step: Entry, late: int, decimals: int
) -> tuple[Fraction, int]:
    """Check the arguments, and return the step and the delay."""
    if is_discrete(system.time):
        raise UsageError("the system is in discrete time already", where="system")
    h = as_requested(step, where="step")
    if h <= 0:
        raise UsageError(f"expected a time above 0, found {rational_text(h)}", where="step")
    if type(decimals) is not int or not 0 <= decimals <= _MOST_DECIMALS:
        raise UsageError(f"expected 0 to 1000 decimals, found {decimals!r}", where="decimals")
    if type(late) is not int or late < 0:
        raise UsageError(f"expected a number of steps from 0 on, found {late!r}", where="late")
    require_size(system.n + late * system.input_matrix().ncols)
    return h, late


def _held(system: MultiChannelSystem) -> Matrix:
    """[A, B], n × (n + p)."""
    return hstack([system.A, system.input_matrix()])


def _radii_with_registers(radii: Radii, missed: Matrix, late: int) -> Radii:
    """The radii of [A_h, B_h], and those of C; registers are certain."""
    around = MultiChannelSystem(radii.A, radii.B, radii.C)
    return Radii(*_with_registers(around, missed, late, 0))


def _with_registers(
    system: MultiChannelSystem, M: Matrix, late: int, one: int
) -> tuple[Matrix, list[Matrix], list[Matrix]]:
    """[A_h, B_h] = M with registers, whose entries are ``one``: certain, so 0 for radii."""
    n, widths = system.n, [system.p(i) for i in range(system.m)]
    p, first = sum(widths), range(system.n)
    columns = [range(sum(widths[:i]), sum(widths[: i + 1])) for i in range(system.m)]
    C = [system.C(i) for i in range(system.m)]
    if not late:
        B = [M.take(cols=[n + k for k in part]) for part in columns]
        return M.take(cols=first), B, C
    N = n + late * p
    shifted = Matrix.from_entries((N - n, N), ((k, n + p + k, one) for k in range(N - n - p)))
    A = vstack([hstack([M, Matrix.zeros(n, N - n - p)]), shifted])
    inputs = [
        Matrix.from_entries((N, len(part)), ((N - p + k, j, one) for j, k in enumerate(part)))
        for part in columns
    ]
    return A, inputs, [hstack([C_i, Matrix.zeros(C_i.nrows, N - n)]) for C_i in C]


def _sizes_with_registers(system: MultiChannelSystem, late: int) -> TypicalSizes | None:
    """The typical sizes of the plant, and those of its inputs for what is under way."""
    sizes = system.typical_sizes
    if sizes is None or not late:
        return sizes
    under_way = [
        x for each in sizes.of_inputs([system.p(i) for i in range(system.m)]) for x in each
    ]
    states = [*sizes.of_states(system.n), *(under_way * late)]
    return TypicalSizes(states, sizes.inputs, sizes.errors, sizes.disturbances)


def _largest(missed: Matrix, decimals: int) -> str:
    """The largest radius of a sampled plant, rounded up."""
    entries = (Fraction(x, missed.denominator) for _, _, x in missed.nonzero())
    largest = max(entries, default=Fraction(0))
    usual = largest <= Fraction(51, 100) / 10**decimals
    return f"0.51e-{decimals}" if usual else three_digits(largest, up=True)


# Controllers in continuous time, at the samples.


def tustin(controller: Controller, plant: MultiChannelSystem) -> Controller:
    """Run a controller in continuous time at the samples of a plant, by Tustin's rule.

    Parameters
    ----------
    controller : Controller
        In continuous time, of agents that share no states.
    plant : MultiChannelSystem
        A plant at its samples, made by `sampled_system`.

    Returns
    -------
    Controller
        In discrete time, for this plant, with the states of the given one.

    Raises
    ------
    UsageError
        If the controller is in discrete time, the plant is not a sampled one, agents share states,
        or I − (h/2)A is singular for the A of an agent.

    Notes
    -----
    Exact.  An agent ż = Az + By, u = Cz + Dy becomes, with X = (I − (h/2)A)⁻¹,

        z(t+1) = X (I + (h/2)A) z + h X B y,   u = C X z + (D + (h/2) C X B) y,

    set-points as outputs.  So s is replaced by (2/h)(z − 1)/(z + 1): what is stable stays so by
    itself, and integrators remain integrators.  That the loop is stable has to be certified.
    States that agents share would have to be known before they are sent.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> plant = MultiChannelSystem([[0]], [[[1]]], [[[1]]])
    >>> lag = local_controllers(plant, [([[-2]], [[1]], [[-3]], [[0]])])
    >>> (agent,) = tustin(lag, sampled_system(plant, "1/2")).agents
    >>> agent.private_update.private.rows(), agent.input.private.rows()
    (((Fraction(1, 3),),), ((Fraction(-2, 1),),))
    """
    InputError.require(controller, Controller, "controller")
    InputError.require(plant, MultiChannelSystem, "plant")
    if is_discrete(controller.time):
        raise UsageError("the controller is in discrete time already", where="controller")
    if not is_sampled(plant) or plant.sample_time is None:
        raise UsageError("expected a plant made by sampled_system", where="plant")
    half = plant.sample_time / 2
    agents = tuple(_at_samples(agent, half) for agent in controller.agents)
    return Controller("discrete", plant.digest_of_values(), agents)


def _at_samples(agent: AgentProgram, half: Fraction) -> AgentProgram:
    """An agent by Tustin's rule; ``half`` is half the step."""
    if agent.shared or any(each.shared for each in agent.maps()):
        raise UsageError(
            f"Tustin's rule does not apply to agent {agent.name}, which uses shared states: "
            "design for the sampled plant",
            where="controller",
        )
    k, update, control = agent.private, agent.private_update, agent.input
    if not k:
        return agent
    identity = Matrix.identity(k)
    A = update.private if update.private is not None else Matrix.zeros(k, k)
    X = inverse(identity - A * half)
    if X is None:
        raise UsageError(
            f"Tustin's rule does not apply to agent {agent.name}, which has the mode 2/h",
            where="controller",
        )
    CX = None if control.private is None else control.private @ X

    def held(M: Matrix) -> Matrix:
        return X @ M * (2 * half)

    def fed(M: Matrix | None, D: Matrix | None) -> Matrix | None:
        """D + (h/2) C X M, where a matrix that is not there is 0."""
        if M is None or CX is None:
            return D
        return CX @ M * half if D is None else D + CX @ M * half

    used = sorted({*update.outputs, *control.outputs})
    outputs = {j: fed(update.outputs.get(j), control.outputs.get(j)) for j in used}
    return replace(
        agent,
        private_update=LinearMap(
            {j: held(M) for j, M in update.outputs.items()},
            private=X @ (identity + A * half),
            reference=None if update.reference is None else held(update.reference),
        ).without_zeros(),
        input=LinearMap(
            {j: M for j, M in outputs.items() if M is not None},
            private=CX,
            reference=fed(update.reference, control.reference),
        ).without_zeros(),
    )


def is_sampled(system: MultiChannelSystem) -> bool:
    """Whether a system was made from a plant by sampling alone.

    Examples
    --------
    >>> plant = MultiChannelSystem([[0]], [[[1]]], [[[1]]])
    >>> is_sampled(sampled_system(plant, 1)), is_sampled(plant)
    (True, False)
    """
    return [each["construction"] for each in system.subject] == ["sampled"]


def resampled(system: MultiChannelSystem, plant: MultiChannelSystem) -> MultiChannelSystem:
    """Sample another plant in the way in which a sampled system was made.

    Parameters
    ----------
    system : MultiChannelSystem
        Made by `sampled_system`.
    plant : MultiChannelSystem
        With the same values, perhaps with other radii.
    """
    (how,) = system.subject
    return sampled_system(plant, Fraction(how["step"]), how["late"], decimals=how["decimals"])
