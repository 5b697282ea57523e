"""Certificates about loops whose inputs are cut off, written by hand."""

from __future__ import annotations

from tests.checker.handmade import Document, certificate, changed, matrix, plant
from tests.checker.performance_plants import form, static

# x(t+1) = x/2 + u, u = -x cut off: M₀ = 1/2, E₀ = 1, U = -1; [3/4, 1/2; ·, 1] for P = 1, Θ = 2.
HALVED = plant([["1/2"]], ([[1]], [[1]]), time="discrete")
CUT = certificate(
    "saturation",
    HALVED,
    {"limits": [[[-1, 2]]], "back_calculation": [matrix(denominator=1)]},
    {"scaling": [2], "sectors": [0], "P": form([1])},
    static(HALVED, -1),
)
# x(t+1) = 2x + u, u = -2x: sat(v) is between 3/4 v and v for |v| ≤ 4/3, so for |x| ≤ 1/2.
DOUBLED = plant([[2]], ([[1]], [[1]]), time="discrete")
NEAR = certificate(
    "saturation",
    DOUBLED,
    {
        "limits": [[[-1, 1]]],
        "back_calculation": [matrix()],
        "region": {"P": form([4]), "radius": "1/3"},
    },
    {"scaling": ["24/5"], "sectors": ["3/4"]},
    static(DOUBLED, -2),
)


# x(t+1) = 2x, which no input moves: x² grows, and so does nothing else.
UNMOVED = plant([[2]], ([[0]], [[1]]), time="discrete")


def integral(gain: int = -1) -> Document:
    """The integral of the output, times a gain, as input."""
    agent = {
        "name": "1",
        "shared": 0,
        "private": 1,
        "shared_update": {},
        "private_update": {"outputs": {"1": [[gain]]}},
        "input": {"private": [[1]]},
    }
    controller = {"time": "continuous", "agents": [agent]}
    return {"construction": "closed_loop", "controller": controller}


# x' = -x + u, z' = -x + sat(z) - z: the integral stops while the input is cut off.
LAGGING = plant([[-1]], ([[1]], [[1]]))
INTEGRAL = certificate(
    "saturation",
    LAGGING,
    {"limits": [[[-1, 1]]], "back_calculation": [matrix([1])]},
    {"scaling": [8], "sectors": [0], "P": form([3], [-2, 5])},
    integral(),
)
# x' = x + u, u = -3x: between 1/2 v and v for |v| ≤ 2, which holds for 9x² ≤ 4.
RISING = plant([[1]], ([[1]], [[1]]))
RISEN = certificate(
    "saturation",
    RISING,
    {
        "limits": [[[-1, 5]]],
        "back_calculation": [matrix()],
        "region": {"P": form([4]), "radius": "1/3"},
    },
    {"scaling": [2], "sectors": ["1/2"]},
    static(RISING, -3),
)
# Two agents, of which the second one has no limits: x_1 and x_2 halve by themselves.
TWO = plant(
    [["1/2", 0], [0, "1/2"]], ([[1], [0]], [[1, 0]]), ([[0], [1]], [[0, 1]]), time="discrete"
)


def gains(*numbers: str) -> Document:
    """The loop of TWO with these gains."""
    agents = [
        {
            "name": str(k),
            "shared": 0,
            "private": 0,
            "shared_update": {},
            "private_update": {},
            "input": {"outputs": {str(k): [[gain]]}},
        }
        for k, gain in enumerate(numbers, start=1)
    ]
    return {"construction": "closed_loop", "controller": {"time": "discrete", "agents": agents}}


ONE_OF_TWO = certificate(
    "saturation",
    TWO,
    {"limits": [[[-1, 1]], [None]], "back_calculation": [matrix(), matrix()]},
    {"scaling": [2], "sectors": [0], "P": form([1], [0, 1])},
    gains("-1", "-1"),
)
# Of the size 1/2: the radius of NEAR is 2/3 of it.
SIZED = changed(
    NEAR,
    ("claim.region.radius", "2/3"),
    ("claim.region.sizes", ["1/2"]),
)
# x' = -x + u and x' = x + u, whose samples are not rational: u = -x and u = -2x cut off.
FALLING = plant([[-1]], ([[1]], [[1]]))


def held(system: Document, decimals: int, *gains: int | str) -> list[Document]:
    """The subject of a loop of samples with constant gains."""
    loop = changed(static(system, *gains), ("controller.time", "discrete"))
    return [{"construction": "sampled", "step": "1/2", "late": 0, "decimals": decimals}, loop]


EXACT = certificate(
    "saturation",
    FALLING,
    {"limits": [[[-1, 1]]], "back_calculation": [matrix()], "exact": True},
    {"scaling": ["4/5"], "sectors": [0], "P": form([1])},
    *held(FALLING, 6, "-1"),
)
EXACT_NEAR = certificate(
    "saturation",
    RISING,
    {
        "limits": [[[-1, 5]]],
        "back_calculation": [matrix()],
        "region": {"P": form([4]), "radius": "1/4"},
        "exact": True,
    },
    {"scaling": [4], "sectors": ["3/4"]},
    *held(RISING, 6, "-2"),
)
ALL = {
    "an input cut off in discrete time": CUT,
    "a region in discrete time": NEAR,
    "an integral with anti-windup": INTEGRAL,
    "a region in continuous time": RISEN,
    "one of two inputs has limits": ONE_OF_TWO,
    "a region in sizes": SIZED,
    "exact samples": EXACT,
    "a region at exact samples": EXACT_NEAR,
}
"""Every one of them is VALID, and says something true."""
