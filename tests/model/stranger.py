"""Rebuilds a closed loop from docs/formats/controller.md alone: python -I stranger.py PLANT CONTROLLER."""

import json
import sys
from fractions import Fraction


def rebuilt(plant, controller):
    """The matrix of the closed loop."""
    agents, channels = controller["agents"], plant["channels"]
    names, n = [agent["name"] for agent in agents], len(plant["A"])
    delays = plant.get("delays", {})

    def matrix(rows):
        return [[Fraction(entry) for entry in row] for row in rows]

    def times(M, N, width):
        return [
            [sum((a * N[k][c] for k, a in enumerate(row)), Fraction()) for c in range(width)]
            for row in M
        ]

    def age(kind, j, i):
        """How old a signal of agent j is when agent i uses it."""
        link = delays.get(names[i], {}).get(names[j], 0)
        return link + (agents[j].get("hold", {}).get(names[i], 0) if kind == "shared" else 0)

    used = {(kind, names.index(name)): 0 for kind in ("shared", "outputs") for name in names}
    for i, agent in enumerate(agents):
        for part in ("shared_update", "private_update", "input"):
            for kind in ("shared", "outputs"):
                for name in agent[part].get(kind, {}):
                    j = names.index(name)
                    used[kind, j] = max(used[kind, j], age(kind, j, i))
    sizes: dict = {("x",): n}
    for j, agent in enumerate(agents):
        sizes |= {("shared", j, 0): agent["shared"], ("private", j, 0): agent["private"]}
    for j, agent in enumerate(agents):
        for kind, size in (("shared", agent["shared"]), ("outputs", len(channels[j]["C"]))):
            sizes |= {(kind, j, old): size for old in range(1, used[kind, j] + 1)}
    N = sum(sizes.values())

    def signal(key):
        """The rows that make a signal of the loop's state."""
        if key[0] == "outputs" and key[2] == 0:
            return times(matrix(channels[key[1]]["C"]), signal(("x",)), N)
        start = sum(size for other, size in list(sizes.items())[: list(sizes).index(key)])
        return [[Fraction(c == start + r) for c in range(N)] for r in range(sizes[key])]

    def value(i, part, height):
        """A map of agent i over the loop's state."""
        terms, total = agents[i][part], [[Fraction()] * N for _ in range(height)]
        parts = [
            (M, (kind, names.index(name), age(kind, names.index(name), i)))
            for kind in ("shared", "outputs")
            for name, M in terms.get(kind, {}).items()
        ]
        parts += [(terms["private"], ("private", i, 0))] if "private" in terms else []
        for M, key in parts:
            added = times(matrix(M), signal(key), N)
            total = [[a + b for a, b in zip(*rows)] for rows in zip(total, added)]
        return total

    loop = times(matrix(plant["A"]), signal(("x",)), N)
    for i, channel in enumerate(channels):
        B = matrix(channel["B"])
        added = times(B, value(i, "input", len(B[0]) if B else 0), N)
        loop = [[a + b for a, b in zip(*rows)] for rows in zip(loop, added)]
    for i, agent in enumerate(agents):
        loop += value(i, "shared_update", agent["shared"]) + value(
            i, "private_update", agent["private"]
        )
    for kind, j, old in [key for key in sizes if len(key) == 3 and key[2]]:
        loop += signal((kind, j, old - 1))
    return loop


if __name__ == "__main__":
    files = (json.load(open(path), parse_float=str) for path in sys.argv[1:3])
    print(json.dumps([[str(entry) for entry in row] for row in rebuilt(*files)]))
