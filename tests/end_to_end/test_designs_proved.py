"""What `design` and `certify` prove is about the plant in the file, with neighbors or without."""

from pathlib import Path

import pytest

from mcexact.model.files import save_system
from mcexact.model.system import MultiChannelSystem
from tests.checker.manifests import digest_of
from tests.end_to_end.command_line import run

GRAPHS = {"without neighbors": None, "with neighbors": {"1": ["2"], "2": ["1"]}}
# The others need a neighbor graph.
DESIGNS = [
    ("decentralized", "without neighbors"),
    *((name, "with neighbors") for name in ("decentralized", "observer", "extended", "setpoint")),
]


def plant_file(folder: Path, graph: str, *, fixed: bool = False) -> str:
    """Two tanks; or one that keeps a mode at 1 whatever is done."""
    path = folder / f"plant-{fixed}.json"
    A = [[1, 0], [0, -2]] if fixed else [[-2, 1], [1, -2]]
    B = [[[0], [0]], [[0], [1]]] if fixed else [[[1], [0]], [[0], [1]]]
    C = [[[1, 0]], [[0, 1]]]
    save_system(MultiChannelSystem(A, B, C, neighbors=GRAPHS[graph]), path)
    return str(path)


def assert_proved_about(plant: str, certificates: Path) -> None:
    """Every certificate in the folder is valid, and about the plant in the file."""
    files = [str(path) for path in sorted(certificates.iterdir()) if path.name != "manifest.json"]
    # Beside its manifest, a certificate about a plant nearby may be about another plant.
    together = run(
        "check", "--statements", *files, str(certificates / "manifest.json"), "--system", plant
    )
    assert files
    assert (together.status, together.stdout.count("VALID ")) == (0, len(files)), together.stdout
    implied = run("check", "--statements", "--manifest", str(certificates), "--system", plant)
    *lines, counted = implied.stdout.splitlines()
    remarks = [line for line in lines if line.startswith("REMARK ")]
    claimed = [line for line in lines if line.startswith("IMPLIED ")]
    judged = len(files) + len(remarks) + len(claimed)
    assert implied.status == 0 and judged == len(lines), lines
    told = "1 remark" if len(remarks) == 1 else f"{len(remarks)} remarks"
    *_, sentences, counts, digest = counted.split("; ")
    assert sentences.endswith(f"{len(claimed)} sentences implied, 0 not, {told}")
    assert counts == f"{len(files)} certificates valid, 0 not"
    assert digest.split()[-1] == digest_of(certificates / "manifest.json")


@pytest.mark.parametrize("arithmetic", ["exact", "float"])
@pytest.mark.parametrize(("name", "graph"), DESIGNS)
def test_a_design_and_its_certification_are_about_the_plant_in_the_file(
    tmp_path: Path, name: str, graph: str, arithmetic: str
) -> None:
    plant, controller = plant_file(tmp_path, graph), str(tmp_path / "controller.json")
    designed = run(
        *("design", name, plant, "--rate", "1/2", "--arithmetic", arithmetic, "-o", controller),
        *("--certificates", str(tmp_path / "designed")),
    )
    assert designed.status == 0, designed.stderr
    assert_proved_about(plant, tmp_path / "designed")
    for rate, status in (("1/2", 0), ("1000000", 1)):
        proof = tmp_path / f"certified-{rate.partition('/')[0]}"
        arguments = (plant, controller, "--rate", rate, "--certificates", str(proof))
        assert run("certify", *arguments).status == status
        assert_proved_about(plant, proof)


@pytest.mark.parametrize(("name", "graph"), DESIGNS)
def test_a_refusal_is_about_the_plant_in_the_file(tmp_path: Path, name: str, graph: str) -> None:
    plant, proof = plant_file(tmp_path, graph, fixed=True), tmp_path / "refused"
    refused = run("design", name, plant, "--rate", "1/2", "--certificates", str(proof))
    assert refused.status == 1, refused.stderr
    assert_proved_about(plant, proof)
