"""Which certificates have the same bytes under every kernel, and which are only valid.

The same questions are asked in processes that multiply with different kernels in different numbers
of threads, and hash strings differently.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from mcexact.answer.sentence import MANIFEST
from mcexact.checker.kinds import KINDS, check_document
from tests.answer.written import DESIGNS, PLANTS
from tests.kernels import usable_kernels

IN_FLOATING_POINT = {f"design-{design}-float" for design in DESIGNS}
IN_FLOATING_POINT |= {"certify-lyapunov", "certify-instability"}
ABOUT_PERFORMANCE = {"cost_bound", "disk_margin", "loop_cost", "saturation", "sector", "step_peaks"}
"""Kinds whose matrices are proposed in floating point: their certificates are only valid."""
ABOUT_BOXES = {"box_fixed", "box_controllable", "box_stable"}
ABOUT_BOXES |= {"parametric_box_fixed", "parametric_box_controllable", "parametric_box_stable"}

Written = dict[str, dict[Path, bytes]]


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Written:
    """All certificates, by the kernel under which they were written and by their place."""
    kernels = usable_kernels()[:3]
    if len(kernels) < 2:
        pytest.skip("this processor runs one kernel only")
    found = {}
    for seed, kernel in enumerate(kernels):
        folder = tmp_path_factory.mktemp(kernel)
        added = {
            "OPENBLAS_CORETYPE": kernel,
            "OPENBLAS_NUM_THREADS": str(seed + 1),
            "PYTHONHASHSEED": str(seed),
        }
        subprocess.run(
            [sys.executable, "-m", "tests.answer.written", str(folder)],
            env=os.environ | added,
            check=True,
            capture_output=True,
        )
        found[kernel] = {
            path.relative_to(folder): path.read_bytes()
            for path in folder.glob("*/**/*.json")
            if path.name != MANIFEST
        }
    return found


def found_in_floating_point(document: dict[str, Any]) -> bool:
    """Whether FORMAT.md says that this evidence was found in floating point."""
    if document["kind"] in ABOUT_BOXES | ABOUT_PERFORMANCE:
        return True
    return document["kind"] == "stability" and document["witness"]["method"] != "polynomial"


def of_a_design_in_floating_point(place: Path) -> bool:
    """Whether it is in the folder of such a design, or about a plant that such a search found."""
    return place.stem == "failing_loop" or any(part.endswith("-float") for part in place.parts)


def test_what_is_found_exactly_has_the_same_bytes_under_every_kernel(written: Written) -> None:
    first, *others = written.values()
    kinds = set()
    for place, data in first.items():
        document = json.loads(data)
        if of_a_design_in_floating_point(place) or found_in_floating_point(document):
            continue
        kinds.add(document["kind"])
        for other in others:
            assert other[place] == data, place
    assert kinds == set(KINDS) - ABOUT_BOXES - ABOUT_PERFORMANCE


def test_what_is_found_in_floating_point_is_valid_under_every_kernel(written: Written) -> None:
    for certificates in written.values():
        proposed = {
            place: data
            for place, data in certificates.items()
            if of_a_design_in_floating_point(place) or found_in_floating_point(json.loads(data))
        }
        for place, data in proposed.items():
            verdict = check_document(data)
            assert verdict.verdict == "VALID", f"{place}: {verdict.line()}"
        kinds = {place: json.loads(data)["kind"] for place, data in proposed.items()}
        assert ABOUT_BOXES <= {*kinds.values()}
        assert {"cost_bound", "disk_margin", "loop_cost", "step_peaks"} <= {*kinds.values()}
        # Exact designs have a box around their loop, too, a plant near theirs whose loop fails, and
        # proofs of cost and margins.
        proposed_for_all = ABOUT_BOXES | ABOUT_PERFORMANCE
        rest = [
            place
            for place, kind in kinds.items()
            if kind not in proposed_for_all and place.stem != "failing_loop"
        ]
        asked = {(place.parts[0], place.parts[1]) for place in rest}
        assert {name for _, name in asked} == IN_FLOATING_POINT
        assert {plant for plant, name in asked if name.startswith("certify")} == set(PLANTS)
