"""Rebuilds a closed loop from docs/formats/controller.md alone: python -I stranger.py PLANT CONTROLLER."""

import json
import sys
from fractions import Fraction

MAPS = ("shared_update", "private_update", "input")


def rebuilt(plant, controller):
    """The matrix of the closed loop, column by column: one step from each unit vector."""
    agents = {agent["name"]: agent for agent in controller["agents"]}
    channels = dict(zip(agents, plant["channels"]))

    def age(kind, j, i):
        """How old a signal of agent j is when agent i uses it."""
        link = plant.get("delays", {}).get(i, {}).get(j, 0)
        return link + (agents[j].get("hold", {}).get(i, 0) if kind == "shared" else 0)

    def times(M, v):
        return [sum(Fraction(entry) * x for entry, x in zip(row, v)) for row in M]

    def plus(v, w):
        return [a + b for a, b in zip(v, w)]

    sizes: dict = {"x": len(plant["A"])}
    for i, agent in agents.items():
        sizes |= {("shared", i, 0): agent["shared"], ("private", i, 0): agent["private"]}
    for j in agents:
        for kind, size in (("shared", agents[j]["shared"]), ("outputs", len(channels[j]["C"]))):
            uses = [i for i, a in agents.items() if any(j in a[p].get(kind, {}) for p in MAPS)]
            oldest = max((age(kind, j, i) for i in uses), default=0)
            sizes |= {(kind, j, old): size for old in range(1, oldest + 1)}

    def step(state):
        """The derivatives, or the values after one step."""
        signals = state | {("outputs", j, 0): times(channels[j]["C"], state["x"]) for j in agents}

        def value(i, part, size):
            terms, total = agents[i][part], [0] * size
            used = [(terms["private"], ("private", i, 0))] if "private" in terms else []
            for kind in ("shared", "outputs"):
                used += [(M, (kind, j, age(kind, j, i))) for j, M in terms.get(kind, {}).items()]
            for M, key in used:
                total = plus(total, times(M, signals[key]))
            return total

        after: dict = {"x": times(plant["A"], state["x"])}
        for i, agent in agents.items():
            for row in channels[i]["B"][:1]:
                after["x"] = plus(after["x"], times(channels[i]["B"], value(i, "input", len(row))))
            for kind in ("shared", "private"):
                after[kind, i, 0] = value(i, f"{kind}_update", agent[kind])
        for kind, j, old in [key for key in sizes if key not in after]:
            after[kind, j, old] = signals[kind, j, old - 1]
        return [x for key in sizes for x in after[key]]

    columns = []
    for k in range(sum(sizes.values())):
        unit = (Fraction(c == k) for c in range(sum(sizes.values())))
        columns.append(
            step({key: [next(unit) for _ in range(size)] for key, size in sizes.items()})
        )
    return list(zip(*columns))


if __name__ == "__main__":
    files = (json.load(open(path), parse_float=str) for path in sys.argv[1:3])
    print(json.dumps([[str(entry) for entry in row] for row in rebuilt(*files)]))
