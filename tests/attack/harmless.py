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
    "absence.py: require_no_more: self.number is None": UNREAD,
    "arithmetic.py: inverse: math.gcd(number, ell) != 1": RAISES,
    "assignability.py: _require_minimal: len(columns) != d": SHAPE,
    "blocks.py: _channels: max(moved) <= min(seen)": (
        "a channel that leads to a later block acts within none, and leaving out a channel proves less"
    ),
    "box_fixed.py: check: number is not None and integer(number, where) >= len(pencils)": RAISES,
    "box_stable.py: check: growth is None": UNREAD,
    "box_stable.py: check: integer(number, where) >= len(found)": RAISES,
    "box_stable.py: segments_of: all((a < b for a, b in pairwise(points)))": (
        "a way along the border that also goes back leaves no gap before the last point"
    ),
    "closed_loop_spectrum.py: require_spectrum: len(p) == A.nrows + 1": (
        "polynomials of different degrees differ modulo every modulus, being monic"
    ),
    "closed_loop_spectrum.py: require_spectrum: math.gcd(D, ell) == 1": (
        "the matrix cannot be reduced modulo a number that divides a denominator"
    ),
    "common_dimension.py: check: (cut is not None) == needed": UNREAD,
    "communication.py: check: (sizes is None) == (share == 'outputs')": (
        "the statement cannot be made, and the document is refused for that"
    ),
    "complementary_subsystem.py: check: v <= n": "no matrix has a negative number of rows",
    "complementary_subsystem.py: check: free >= 0": "no matrix has a negative number of columns",
    "controllability.py: check: len(pivots) == n - d": SHAPE,
    "covers.py: require_covered: used < len(items(nodes, where))": (
        "without the first of the two there is an error, and nodes that are left over prove nothing"
    ),
    "covers.py: require_covered: integer(node, where) >= len(frames)": RAISES,
    "covering.py: require_bound: bool(boxes)": RAISES,
    "covering.py: require_bound: label not in self.labels": RAISES,
    "covering.py: _cut: integer(number, place) >= len(self.cuts)": RAISES,
    "common_dimension.py: check: absence is None": UNREAD,
    "controllability_indices.py: check: ranks[-1] <= n": "no matrix has a negative number of rows",
    "distributed_observer.py: separated: len(blocks) > 1": RAISES,
    "evidence.py: modulus: ell >= 2": (
        "modulo 1 every number is 0 and nothing is shown, modulo 0 there is an error, and a "
        "negative number shows what its absolute value shows"
    ),
    "reading.py: names: type(entry) is not str or entry not in place_of": RAISES,
    "region.py: claimed_cost: absence is None": UNREAD,
    "system_matrices.py: number: not good or abs(int(exponent)) > (limits or Limits).exponent": CANONICAL,
    "expressions.py: whole: match is None": RAISES,
    "expressions.py: whole: self.tokens": CANONICAL,
    "expressions.py: sum: self.depth > DEEPEST": CANONICAL,
    "expressions.py: product: not c": RAISES,
    "expressions.py: power: not digits.isdigit() or len(digits) > 9": CANONICAL,
    "expressions.py: atom: not self.take(')')": CANONICAL,
    "expressions.py: atom: not token[:1].isdigit()": REPEATED,
    "named_matrices.py: named_matrix: type(name) is not str or name not in KEYS": RAISES,
    "parameter_cells.py: cells_of: low is None or high is None": RAISES,
    "parameter_cells.py: cells_of: bool(left)": RAISES,
    "parameter_cells.py: cells_of: integer(cut, f'{place}[{k}]') >= len(cell)": RAISES,
    "parametric_rank.py: check: r <= min(nrows, ncols)": "no minor has more rows or columns",
    "parametric_rank.py: check: kernel is None": UNREAD,
    "parametric_system.py: plant_of_file: not isinstance(document, dict) or document.get('format') != 'mcexact-system/1'": USERS,
    "parametric_system.py: read_parametric: not isinstance(known, dict) or not known": RAISES,
    "parametric_system.py: _table: integer(i, place) >= r or integer(j, place) >= c or (i, j) in seen": CANONICAL,
    "deficiency.py: check: coefficients is None": UNREAD,
    "deficiency.py: check: subspace is None": UNREAD,
    "controller.py: read_controller: not agents": (
        "a controller without agents fits a system without channels alone, and changes nothing"
    ),
    "controller.py: read_controller: len({M.nrows for M in read}) > 1": (
        "in a certificate each matrix has the shape that the plant needs"
    ),
    "controller.py: read_controller_file: version != FORMAT": USERS,
    "expectation.py: saying: not line or not text.isascii() or len(text.splitlines()) != 1": USERS,
    "expectation.py: saying: line[1] not in (None, found)": USERS,
    "expectation.py: _claiming: 'claim' not in value": USERS,
    "expectation.py: _claiming: not isinstance(claim, dict)": USERS,
    "expectation.py: named: not DIGEST.fullmatch(value)": USERS,
    "expectation.py: _require_system: self.system in ('', found, values)": USERS,
    "expectation.py: require_plant: ranged or self.made_for in ('', values)": USERS,
    "expectation.py: require_subject: bool(found)": USERS,
    "expectation.py: require_subject: found == self.controller": USERS,
    "expectation.py: require_subject: same(steps, expected)": USERS,
    "expectation.py: require_said: self.kind in ('', kind)": USERS,
    "expectation.py: require_said: self.statement in ('', digest_of(statement))": USERS,
    "expectation.py: require_said: self.claim is None or same(claim, self.claim)": USERS,
    "system.py: _check_unused: period is not None and (period <= 0 or plant.time != 'discrete')": USERS,
    "system.py: _require_no_feedthrough: D is not None and (not read_matrix(D, place, None, None, limits).is_zero())": USERS,
    "system.py: read_system_file: not isinstance(document, dict) or document.get('format') != 'mcexact-system/1'": USERS,
    "exterior_discs.py: discs_of_gains: not found": RAISES,
    "loop_pencil.py: loop_pencil: gain_radii is None": (
        "the statement says of which controller the gains differ, and is refused if there is none"
    ),
    "loop_pencil.py: _pencil: used <= reads.keys()": RAISES,
    "uncertainty.py: radii_form: part < 0": USERS,
    "fixed_spectrum.py: check: completion is None": UNREAD,
    "kinds.py: _parts: not isinstance(document, Mapping)": RAISES,
    "pencil_rank.py: check: len(pivots) == c - r": SHAPE,
    "reading.py: parse: depth > limits.depth": "no kind reads anything that is nested so deep",
    "reading.py: fields: not isinstance(value, Mapping)": RAISES,
    "reading.py: fields: key in optional and value[key] is None": RAISES,
    "reading.py: polynomial_matrix: not 1 <= len(items(layers, f'{place}.coefficients')) <= degree": (
        "no layer is a matrix of zeros; a layer too many has no coefficient of p to go with it"
    ),
    "region.py: require_absence: (number is None) == (arcs is None)": UNREAD,
    "region.py: _without: times == integer(power, where, 1)": (
        "the exponent is computed, and the claimed one only compared"
    ),
    "root_discs.py: root_discs: slope > 0": (
        "a disc around a multiple root leaves fewer roots than there are other discs, which are "
        "disjoint and hold one each"
    ),
    "setpoint.py: check: r <= rows": "no matrix has a negative number of rows",
    "setpoint.py: check: len(pivots) == rows - r": SHAPE,
    "setpoint.py: check: row is None": UNREAD,
    "setpoint.py: check: x0 is None": UNREAD,
    "single_channel_gains.py: check: cyclic or b is None": UNREAD,
    "stability.py: check: block.stop <= M.nrows": RAISES,
    "subject.py: read_subject: not isinstance(step, dict) or type(step.get('construction')) is not str": RAISES,
    "system_matrices.py: read_matrix: integer(i, place) >= r or integer(j, place) >= c or (i, j) in cells": LARGE,
    "system.py: _with_graph: len(set(found)) < len(found)": CANONICAL,
    "transfer_graph.py: read_arcs: type(end) is not str or end not in known": RAISES,
    "transfer_graph.py: require_arcs: k < system.n": (
        "a power beyond n shows an edge as well; the condition bounds the work"
    ),
}  # fmt: skip
