"""Conditions without which nothing false is accepted, and why that is so."""

from __future__ import annotations

SHAPE = "what follows fails as well: the rows or columns named have to form an identity matrix"
UNREAD = "the field is read nowhere: it may hold nothing, so that a claim has one form of proof"
RAISES = "without it the same document raises an error a few lines later, which is not VALID"
USERS = "about files or wishes of a user, which no certificate reaches; tests/checker has its tests"
LARGE = (
    "large matrices alone list their entries, and are not drawn here; tests/checker has its tests"
)
REPEATED = "what is refused here is refused a few lines later as well, for another reason"
CANONICAL = "the object `system` has to be equal to its canonical form as well"

# The keys are conditions as they stand in the checker.
# ruff: noqa: E501
HARMLESS: dict[str, str] = {
    "reading.py: _integer_rows: not all((type(entry) is int for entry in items(row, f'{place}[{i}]', ncols)))": (
        "true counts as 1 and false as 0, and whatever else is no integer raises an error"
    ),
    "kinds.py: require_statement: saturation.agrees(claim, self.saturation)": USERS,
    "evidence.py: require_bounded: all((c.denominator == 1 for c in scaled))": (
        "a factor that is proved to be fixed divides det(xI - A), and is integral where A is"
    ),
    "fixed_modes.py: check_fixed_spectrum: len(unsaid) == len(modes)": (
        "a factor whose multiplicity in A is said remains in what is left of det(xI - A_F), which "
        "has to be coprime with det(xI - A)"
    ),
    "saturation.py: check_saturation: form is None": UNREAD,
    "saturation.py: spread: plant.missed is not None": RAISES,
    "saturation.py: check_region: nearer > 0": RAISES,
    "saturation.py: check_region: radius > 0": (
        "no state has a norm below 0, and with 0 there is an error"
    ),
    "boxes.py: read_disk: box.plant is not None": (
        "places of states are taken for those of ports then, and no frame proves of a state on the "
        "whole border what is asked of a signal"
    ),
    "boxes.py: read_disk: bool(ports)": RAISES,
    "cells.py: bottom_of: bool(below)": RAISES,
    "constructions.py: _at_once: False": RAISES,
    "constructions.py: _without_links: system.neighbors is not None": RAISES,
    "constructions.py: periodic_loop: not phases": RAISES,
    "constructions.py: merged: bool(parts)": (
        "no parts are all channels of a closed loop alone, which has none and stays what it is"
    ),
    "constructions.py: sampled_within: decimals <= MOST_DECIMALS": (
        "an enclosure to more decimals is as true, and its work is counted"
    ),
    "constructions.py: read_subject: name != LINE": (
        "a line is not among the constructions of a plant without parameters, so that the document "
        "is INCOMPLETE"
    ),
    "performance.py: symmetric: any((each > LARGEST for each in e))": (
        "larger exponents are as exact, and the work is counted"
    ),
    "performance.py: require_positive: even": "every caller makes a symmetric matrix",
    "performance.py: require_positive: all((S.rows[i][i] > 0 for i in range(n)))": (
        "no congruence of a matrix that is not definite is dominant: this only spares work"
    ),
    "performance.py: require_positive: all((2 * bits[i][j] <= bits[i][i] + bits[j][j] + 1 for i in range(n) for j in range(i)))": (
        "no congruence of a matrix that is not definite is dominant: this only spares work, and an "
        "overflow on the way"
    ),
    "patterns.py: read_places: type(information) is not str or information not in INFORMATION": RAISES,
    "patterns.py: _whole: number < 2 ** 31": "longer potentials prove as much; they are counted as short ones",
    "performance.py: loop_of: system.loop is not None": RAISES,
    "performance.py: read_graph: (j, i) <= before or j == i": (
        "the order of edges, and an edge from an agent to itself, say nothing"
    ),
    "performance.py: check_disk_margin: all(scaling)": (
        "with 0 in the scaling the inequality has 0 on its diagonal, and is not strict"
    ),
    "performance.py: check_sector: all(scaling)": (
        "with 0 in the scaling the inequality has no number above 0 at that place of its diagonal"
    ),
    "sharing.py: check_shared_dimensions: value is not None": RAISES,
    "sharing.py: _require_multipliers: end is None": (
        "costs are positive, so that the value, which leaves with multipliers need, bounds every variable"
    ),
    "sharing.py: check_shared_dimensions: 0 <= below < value": (
        "every cost is at least 0 and what is claimed to be attained is: a number out of these "
        "bounds is proved in the same way, or cannot be"
    ),
    "sharing.py: check_shared_dimensions: not connected": (
        "multipliers of any cuts prove their sum, those of connections too; the theorem has them not"
    ),
    "sharing.py: require_nested: integer(number, place) >= len(subsets)": RAISES,
    "sharing.py: require_nested: inner is None or inner < subsets[number]": (
        "multipliers of any cuts prove their sum; the theorem has it for nested ones"
    ),
    "sharing_gap.py: require_no_more_relays: relays <= most": (
        "the search does not end without it, and its work is counted"
    ),
    "system.py: read_system: A.nrows != A.ncols or not items(listed, 'channels')": RAISES,
    "system.py: read_system: whole is not None": CANONICAL,
    "system.py: read_system: doubt is not None and whole is not None": (
        "the construction is applied to the radii as well, and what is claimed then holds for the "
        "same D in all plants within them"
    ),
    "system.py: _feedthrough: (read.nrows, read.ncols) != (nrows, ncols)": (
        "of a larger matrix than that of the ports the rest is read nowhere, and a smaller one "
        "raises an error"
    ),
    "system.py: _check_unused: not all((1 <= number <= q for number in listed))": USERS,
    "system.py: _check_sizes: len(values) != count or any((x <= 0 for x in values))": USERS,
    "steps.py: positive: all((each > 0 for each in numbers))": (
        "a bound divided by a size below 0 is below every absolute value, and 0 raises an error"
    ),
    "steps.py: read_peaks: any((entry < 0 for row in rows for entry in row))": REPEATED,
    "steps.py: check_step_peaks: places > MOST_BITS or e > FARTHEST": (
        "longer numbers are as exact, and a larger unit hides more; the work is counted"
    ),
    "steps.py: __init__: all((abs(number) < 1 << bits for row in entering for number in row))": RAISES,
    "steps.py: _terms: False": (
        "terms that do not become small in 500 are so large that numbers or bounds fail as well"
    ),
    "evidence.py: require_no_more: self.number is None": UNREAD,
    "arithmetic.py: inverse: math.gcd(number, ell) != 1": RAISES,
    "modes.py: _require_minimal: len(columns) != d": SHAPE,
    "evidence.py: _channels: max(driven) <= min(seen)": (
        "a channel that leads to a later block acts within none, and leaving out a channel proves less"
    ),
    "evidence.py: _loss: names(listed, f'{place}.channels_T', system.names) == T": (
        "T is computed, and the claimed one only compared"
    ),
    "evidence.py: _local_subspace: names(listed, f'{place}.channels_T', self.system.names) == T": (
        "T is computed, and the claimed one only compared"
    ),
    "boxes.py: check_box_fixed: number is not None and integer(number, where) >= len(pencils)": RAISES,
    "boxes.py: check_box_stable: growth is None": UNREAD,
    "boxes.py: check_box_stable: integer(number, where) >= len(regular)": RAISES,
    "boxes.py: segments_of: all((a < b for a, b in pairwise(points)))": (
        "a way along the border that also goes back leaves no gap before the last point"
    ),
    "loops.py: require_spectrum: len(p) == A.nrows + 1": (
        "polynomials of different degrees differ modulo every modulus, being monic"
    ),
    "loops.py: require_spectrum: math.gcd(D, ell) == 1": (
        "the matrix cannot be reduced modulo a number that divides a denominator"
    ),
    "sharing.py: check_common_dimension: (cut is not None) == needed": UNREAD,
    "sharing.py: check_communication: (sizes is None) == (share == 'outputs')": (
        "the statement cannot be made, and the document is refused for that"
    ),
    "structure.py: check_complementary_subsystem: v <= n": "no matrix has a negative number of rows",
    "structure.py: check_complementary_subsystem: free >= 0": "no matrix has a negative number of columns",
    "structure.py: relation_degrees: any((j >= B.ncols for j in own))": RAISES,
    "discs.py: require_covered: used < len(items(nodes, where))": (
        "without the first of the two there is an error, and nodes that are left over prove nothing"
    ),
    "discs.py: require_covered: integer(node, where) >= len(frames)": RAISES,
    "sharing.py: require_bound: bool(boxes)": RAISES,
    "sharing.py: require_bound: label not in self.labels": RAISES,
    "sharing.py: _cut: integer(number, place) >= len(self.cuts)": RAISES,
    "sharing.py: check_common_dimension: absence is None": UNREAD,
    "structure.py: check_controllability_indices: ranks[-1] <= n": "no matrix has a negative number of rows",
    "loops.py: separated: len(blocks) > 1": RAISES,
    "evidence.py: modulus: ell >= 2": (
        "modulo 1 every number is 0 and nothing is shown, modulo 0 there is an error, and a "
        "negative number shows what its absolute value shows"
    ),
    "reading.py: names: type(entry) is not str or entry not in place_of": RAISES,
    "modes.py: claimed_cost: absence is None": UNREAD,
    "system.py: number: not good or abs(int(exponent)) > (limits or Limits).exponent": CANONICAL,
    "parametric_system.py: whole: match is None": RAISES,
    "parametric_system.py: whole: self.tokens": CANONICAL,
    "parametric_system.py: sum: self.depth > DEEPEST": CANONICAL,
    "parametric_system.py: product: not c": RAISES,
    "parametric_system.py: power: not digits.isdigit() or len(digits) > 9": CANONICAL,
    "parametric_system.py: atom: not self.take(')')": CANONICAL,
    "parametric_system.py: atom: not token[:1].isdigit()": REPEATED,
    "bivariate.py: named_matrix: type(name) is not str or name not in KEYS": RAISES,
    "cells.py: cells_of: low is None or high is None": RAISES,
    "cells.py: cells_of: bool(left)": RAISES,
    "cells.py: cells_of: integer(cut, f'{place}[{k}]') >= len(cell)": RAISES,
    "parameters.py: check_parametric_rank: r <= min(nrows, ncols)": "no minor has more rows or columns",
    "parameters.py: check_parametric_rank: kernel is None": UNREAD,
    "parametric_system.py: plant_of_file: not isinstance(document, dict) or document.get('format') != 'mcexact-system/1'": USERS,
    "parametric_system.py: read_parametric: not isinstance(known, dict) or not known": RAISES,
    "parametric_system.py: _table: integer(i, place) >= r or integer(j, place) >= c or (i, j) in seen": CANONICAL,
    "modes.py: check_deficiency: coefficients is None": UNREAD,
    "modes.py: check_deficiency: subspace is None": UNREAD,
    "controllers.py: read_controller: not agents": (
        "a controller without agents fits a system without channels alone, and changes nothing"
    ),
    "controllers.py: read_controller: len({M.nrows for M in read}) > 1": (
        "in a certificate each matrix has the shape that the plant needs"
    ),
    "controllers.py: read_controller_file: version != FORMAT": USERS,
    "kinds.py: _read: len(data) > limits.bytes or hashlib.sha256(data).hexdigest() == value": USERS,
    "system.py: parse_canonical: canonical_json(value).encode('ascii') != data": USERS,
    "kinds.py: saying: not line or not text.isascii() or len(text.splitlines()) != 1": USERS,
    "kinds.py: saying: line[1] not in (None, digest)": USERS,
    "kinds.py: _claiming: 'claim' not in value": USERS,
    "kinds.py: _claiming: not isinstance(claim, dict)": USERS,
    "kinds.py: named: not DIGEST.fullmatch(value)": USERS,
    "kinds.py: _require_system: self.system in ('', digest, values)": USERS,
    "kinds.py: require_plant: ranged or self.made_for in ('', named)": USERS,
    "kinds.py: require_subject: bool(digest)": USERS,
    "kinds.py: require_subject: digest == self.controller": USERS,
    "kinds.py: require_subject: same(steps, expected)": USERS,
    "kinds.py: require_statement: self.kind in ('', kind)": USERS,
    "kinds.py: require_statement: self.statement in ('', digest_of(statement))": USERS,
    "kinds.py: require_statement: self.claim is None or same(claim, self.claim)": USERS,
    "system.py: _check_unused: period is not None and (period <= 0 or plant.time != 'discrete')": USERS,
    "system.py: read_system_file: not isinstance(document, dict) or document.get('format') != 'mcexact-system/1'": USERS,
    "discs.py: discs_of_gains: not lists": RAISES,
    "discs.py: loop_pencil: gain_radii is None": (
        "the statement says of which controller the gains differ, and is refused if there is none"
    ),
    "discs.py: _pencil: used <= reads.keys()": RAISES,
    "system.py: radii_form: part < 0": USERS,
    "fixed_modes.py: check_fixed_spectrum: completion is None": UNREAD,
    "kinds.py: _parts: not isinstance(document, Mapping)": RAISES,
    "modes.py: check_pencil_rank: len(pivots) == c - r": SHAPE,
    "reading.py: parse: depth > limits.depth": "no kind reads anything that is nested so deep",
    "reading.py: fields: not isinstance(value, Mapping)": RAISES,
    "reading.py: fields: key in optional and value[key] is None": RAISES,
    "reading.py: polynomial_matrix: not 1 <= found <= most": (
        "no layer is a matrix of zeros; a layer too many has no coefficient of p to go with it"
    ),
    "modes.py: require_fixed_modes_inside: (number is None) == (arcs is None)": UNREAD,
    "modes.py: _without: times == integer(power, where, 1)": (
        "the exponent is computed, and the claimed one only compared"
    ),
    "roots.py: root_discs: slope > 0": (
        "a disc around a multiple root leaves fewer roots than there are other discs, which are "
        "disjoint and hold one each"
    ),
    "reach.py: check_setpoint: r <= rows": "no matrix has a negative number of rows",
    "reach.py: check_setpoint: len(pivots) == rows - r": SHAPE,
    "reach.py: check_setpoint: row is None": UNREAD,
    "reach.py: check_setpoint: x0 is None": UNREAD,
    "structure.py: check_single_channel_gains: cyclic or b is None": UNREAD,
    "loops.py: check_stability: block.stop <= M.nrows": RAISES,
    "constructions.py: read_subject: not isinstance(step, dict) or type(step.get('construction')) is not str": RAISES,
    "system.py: read_matrix: integer(i, place) >= r or integer(j, place) >= c or (i, j) in cells": LARGE,
    "system.py: _with_graph: len(set(senders)) < len(senders)": CANONICAL,
    "reach.py: read_arcs: type(end) is not str or end not in known": RAISES,
    "reach.py: require_arcs: k < system.n": (
        "a power beyond n shows an edge as well; the condition bounds the work"
    ),
}  # fmt: skip
