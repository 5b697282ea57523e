"""Forgeries about boxes."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

from tests.oracle.drawn.plants import Document, number

Forged = Document | None


def radii_grown(rng: random.Random, document: Document) -> Forged:
    """Every radius, or those of A, of all B or of all C, are many times as large."""
    doubts = document["system"].get("uncertainty")
    if doubts is None:
        return None
    factor = rng.choice((2, 10, 40))
    parts = doubts["absolute"]
    for key in rng.choice(([*parts], [rng.choice([*parts])])):
        part = parts[key]
        for M in [part] if key == "A" else part.values():
            for entry in M["entries"]:
                entry[2] = number(factor * Fraction(entry[2]))
    return document


def radius_added(rng: random.Random, document: Document) -> Forged:
    """An entry of A is uncertain that was not."""
    A = document["system"]["A"]
    if not isinstance(A, list) or not A:
        return None
    parts = document["system"].setdefault("uncertainty", {"absolute": {}})["absolute"]
    listed = parts.setdefault("A", {"shape": [len(A), len(A)], "entries": []})["entries"]
    place = [rng.randrange(len(A)), rng.randrange(len(A))]
    listed[:] = sorted([*(e for e in listed if e[:2] != place), [*place, rng.choice((1, 3))]])
    return document


def channel_cut(rng: random.Random, document: Document) -> Forged:
    """A channel measures nothing, or something else: its radius reaches 0."""
    channel = rng.choice(document["system"]["channels"])
    rows = channel[rng.choice("BC")]
    if not isinstance(rows, list):
        return None
    for row in rows:
        row[:] = [0] * len(row)
    return document


def disc_shrunk(rng: random.Random, document: Document) -> Forged:
    """An exterior disc is smaller, or elsewhere."""
    exterior = document["witness"].get("exterior")
    if not exterior:
        return None
    k = rng.randrange(len(exterior))
    discs = exterior[k]["discs"]
    if not discs:
        return None
    disc = rng.choice(discs)
    disc[rng.choice(("radius", "re", "im"))] = rng.choice(("0", "0.01", "-5", "7"))
    if k:
        document["witness"]["cover"] = [[] for _ in exterior[0]["discs"]]
    elif rng.random() < 0.5:
        document["witness"]["cover"][discs.index(disc)] = []
    return document


def matrix_exchanged(rng: random.Random, document: Document) -> Forged:
    """Exterior discs are said to be of another matrix, or come twice, and nothing is covered."""
    exterior = document["witness"].get("exterior")
    if not exterior:
        return None
    given = [entry["F"] for entry in exterior]
    size = [len(channel["B"][0]) for channel in document["system"]["channels"] if channel["B"]]
    zeros = [{"denominator": 1, "entries": [[0] * p for _ in range(p)]} for p in size]
    how = rng.randrange(4)
    if how == 0:
        rng.choice(exterior)["F"] = rng.choice((None, zeros, *given))
    elif how == 1:
        exterior.append({**rng.choice(exterior), "F": rng.choice((None, zeros, *given))})
    elif how == 2:
        del exterior[rng.randrange(len(exterior))]
    else:
        exterior.reverse()
    if exterior:
        document["witness"]["cover"] = [[] for _ in exterior[0]["discs"]]
    return document


def matrix_cleared(rng: random.Random, document: Document) -> Forged:
    """Y, T, V or R is 0."""
    witness = document["witness"]
    found: list[Any] = [frame[key] for frame in witness["frames"] for key in "VR" if key in frame]
    found += [discs[key] for discs in witness.get("exterior", []) for key in "YT"]
    if not found:
        return None
    M = rng.choice(found)
    for part in ("re", "im"):
        M[part] = [[0] * len(row) for row in M[part]]
    return document


def weights_changed(rng: random.Random, document: Document) -> Forged:
    """Weights are 0, negative or very uneven."""
    frames = document["witness"]["frames"]
    if not frames:
        return None
    for frame in frames:
        frame["w"] = [rng.choice((0, -1, 1, 10**6)) for _ in frame["w"]]
    return document


def gains_exchanged(rng: random.Random, document: Document) -> Forged:
    """A channel acts on what another one measures, or no gains are behind a frame."""
    witness = document["witness"]
    if not witness.get("gains"):
        return None
    if rng.random() < 0.5:
        given = rng.choice(witness["gains"])
        given["X"] = [{"denominator": 1, "entries": [[3, 3]]} for _ in given["X"]]
        return document
    for frame in witness["frames"]:
        frame["gains"] = None
    return document


def nodes_left_out(rng: random.Random, document: Document) -> Forged:
    """Nodes of the cover are missing, or another frame stands there."""
    cover = document["witness"].get("cover")
    if not cover:
        return None
    k = rng.randrange(len(cover))
    count = len(document["witness"]["frames"])
    cover[k] = rng.choice(([], cover[k][:1], [rng.randrange(count + 1) for _ in cover[k]]))
    return document


def border_cut_off(rng: random.Random, document: Document) -> Forged:
    """Segments of the border are missing, or their points are elsewhere."""
    witness = document["witness"]
    if "points" not in witness or len(witness["points"]) < 2:
        return None
    how = rng.randrange(4)
    if how == 0:
        del witness["points"][-1], witness["segments"][-1]
    elif how == 1:
        witness["points"][0], witness["points"][1] = witness["points"][1], witness["points"][0]
    elif how == 2:
        witness["segments"] = [0] * len(witness["segments"])
    else:
        witness["growth"] = None if rng.random() < 0.5 else [1, *[10**6] * 3]
    return document


def bound_moved(rng: random.Random, document: Document) -> Forged:
    """Another region, or all modes."""
    document["claim"]["bound"] = rng.choice((None, 0, 1, 3, "1/3", "1/9", -1))
    return document


def unstable_nominal(rng: random.Random, document: Document) -> Forged:
    """The values themselves are unstable, and the border is as far away."""
    A = document["system"]["A"]
    if "nominal" not in document["witness"] or not isinstance(A, list):
        return None
    for row in A:
        row[:] = [number(-2 * Fraction(entry)) for entry in row]
    return document


def gain_radii_grown(rng: random.Random, document: Document) -> Forged:
    """The radii of the gains are larger, or negative."""
    radii = document["claim"].get("gain_radii")
    if not radii:
        return None
    value = rng.choice((1, 5, 20, "-1/100"))
    for agent in radii["agents"]:
        for outputs in (agent[label].get("outputs", {}) for label in ("private_update", "input")):
            for name in outputs:
                outputs[name] = [[value] * len(row) for row in outputs[name]]
    return document


def disc_nudged(rng: random.Random, document: Document) -> Forged:
    """A disc is smaller by one unit of its last digit, or by none and its center is elsewhere."""
    exterior = document["witness"].get("exterior")
    if not exterior or not exterior[0]["discs"]:
        return None
    disc = rng.choice(rng.choice(exterior)["discs"])
    key = rng.choice(("radius", "radius", "re", "im"))
    text = disc[key]
    digits = len(text.partition(".")[2])
    steps = rng.choice((1, 1, 100, 10**4))
    moved = Fraction(text) - Fraction(steps, 10**digits)
    whole = abs(moved) * 10**digits
    sign = "-" if moved < 0 else ""
    disc[key] = f"{sign}{int(whole) // 10**digits}" + (
        f".{int(whole) % 10**digits:0{digits}d}" if digits else ""
    )
    return document


def discs_below_the_axis(rng: random.Random, document: Document) -> Forged:
    """Every disc is below the real axis, where nothing has to be covered."""
    exterior = document["witness"].get("exterior")
    if not exterior:
        return None
    for discs in exterior:
        for disc in discs["discs"]:
            disc["im"] = f"-{int(Fraction(disc['radius'])) + rng.choice((1, 2))}"
    document["witness"]["cover"] = [[] for _ in exterior[0]["discs"]]
    return document


def leaves_exchanged(rng: random.Random, document: Document) -> Forged:
    """Leaves of the cover change places, or segments of the border their frames."""
    witness = document["witness"]
    nodes = rng.choice(witness["cover"]) if witness.get("cover") else witness.get("segments")
    if not nodes or len(nodes) < 2:
        return None
    i, j = rng.sample(range(len(nodes)), 2)
    nodes[i], nodes[j] = nodes[j], nodes[i]
    return document


def weights_scaled(rng: random.Random, document: Document) -> Forged:
    """Weights of some rows, or all of a frame, are so many times as large."""
    frames = document["witness"]["frames"]
    if not frames:
        return None
    frame, factor = rng.choice(frames), rng.choice((2, 1000))
    whole = rng.random() < 0.3
    weights = frame["w"]
    if weights and isinstance(weights[0], list):
        weights = rng.choice(weights)
    weights[:] = [w * factor if whole or rng.random() < 0.5 else w for w in weights]
    return document


def radii_exchanged(rng: random.Random, document: Document) -> Forged:
    """A radius stands at another entry of its matrix."""
    parts = document["system"].get("uncertainty", {}).get("absolute", {})
    found = [part for key, part in parts.items() if key == "A"]
    found += [M for key, part in parts.items() if key != "A" for M in part.values()]
    if not found:
        return None
    M = rng.choice(found)
    entry = rng.choice(M["entries"])
    place = [rng.randrange(size) for size in M["shape"]]
    if place in [other[:2] for other in M["entries"]]:
        return None
    entry[:2] = place
    M["entries"].sort()
    return document


def gap_between_points(rng: random.Random, document: Document) -> Forged:
    """A point is left out or moved, and the segments around it keep their frames."""
    witness = document["witness"]
    points = witness.get("points")
    if not points:
        return None
    k = rng.randrange(len(points))
    if rng.random() < 0.5:
        del points[k], witness["segments"][rng.choice((k, k + 1)) if k + 1 < len(points) else k]
    else:
        points[k] = number(Fraction(points[k]) * rng.choice((Fraction(1, 2), Fraction(9, 8), 3)))
    return document


def margin_of_ports(rng: random.Random, document: Document) -> Forged:
    """A larger margin, other ports, ports exchanged or left out, or no disk at all any more."""
    claim, frames = document["claim"], document["witness"].get("frames", [])
    disk = claim.get("disk")
    if disk is None:
        claim["disk"] = {"at": rng.choice(("inputs", "outputs")), "margin": rng.choice((1, "1/9"))}
        for frame in frames:
            frame["w"] = [[*frame["w"], 1, 1]]
        return document
    way = rng.randrange(5)
    if way < 2:
        by = rng.choice((Fraction(1001, 1000), Fraction(11, 10), Fraction(3, 2), Fraction(4)))
        disk["margin"] = number(Fraction(disk["margin"]) * by)
    elif way == 2:
        disk["at"] = "outputs" if disk["at"] == "inputs" else "inputs"
    elif way == 3:
        for frame in frames:
            rng.shuffle(frame["w"])
    else:
        k = rng.randrange(len(frames[0]["w"])) if frames and frames[0]["w"] else 0
        for frame in frames:
            del frame["w"][k : k + 1]
    return document


ANY = (
    radii_grown,
    radius_added,
    radii_exchanged,
    channel_cut,
    matrix_cleared,
    weights_changed,
    weights_scaled,
    leaves_exchanged,
    bound_moved,
)
COVERED = (
    *ANY,
    disc_shrunk,
    disc_nudged,
    discs_below_the_axis,
    matrix_exchanged,
    nodes_left_out,
)
FIXED = (*COVERED, gains_exchanged)
STABLE = (
    *ANY,
    border_cut_off,
    gap_between_points,
    unstable_nominal,
    gain_radii_grown,
    margin_of_ports,
)
