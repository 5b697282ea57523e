"""Published plants and starting files, which need no file."""

import json

import pytest

import mcexact
from mcexact.answer.parameters import in_parameter, mode_text
from mcexact.answer.several_parameters import mode_in_x
from mcexact.model import gallery
from mcexact.model.files import read_any
from mcexact.model.gallery import published
from mcexact.model.system_file import read_system
from tests.cli.calling import call
from tests.wording import says


def test_the_list_names_every_plant_with_its_source_and_what_it_shows() -> None:
    status, out, _ = call("gallery", "--json")
    assert status == 0
    plants = json.loads(out)["plants"]
    assert [each["name"] for each in plants] == sorted(
        [*gallery.names(), *gallery.parametric_names()]
    )
    assert [each["name"] for each in plants if not each["parameters"]] == list(mcexact.gallery())
    for plant in plants:
        if plant["parameters"]:
            continue
        system = mcexact.gallery(plant["name"])
        assert (plant["n"], plant["m"], plant["time"]) == (system.n, system.m, system.time)
        assert plant["source"] and plant["shows"] and "(-" not in plant["shows"]
        known = gallery.expected(plant["name"])
        assert plant["shows"].startswith("fixed: " if known["fixed_factors"] else "no fixed mode")
    status, out, _ = call("gallery")
    assert status == 0 and all(plant["name"] in out for plant in plants)


@pytest.mark.parametrize("name", gallery.parametric_names())
def test_what_is_known_of_a_plant_with_parameters_is_what_is_decided(name: str) -> None:
    plant = mcexact.parameters.load_parametric_system(f"gallery:{name}")
    known, [each] = gallery.expected(name), [p for p in published() if p.name == name]
    assert plant.source and each.parameters == plant.parameters
    for value in (*known["generic"], *known["exceptional"]):
        assert value in each.shows
    if len(plant.parameters) > 1:
        found = mcexact.parameters.exceptional_hypersurfaces(plant)
        exceptional = [str(surface.polynomial) for surface in found.hypersurfaces]
        generic = [mode_in_x(p) for p in found.generic]
    else:
        spectrum = mcexact.fixed_spectrum(plant)
        [t] = plant.parameters
        exceptional = [in_parameter(value.value, t) for value in spectrum.exceptional]
        generic = [mode_text(p, t) for p in spectrum.generic]
    assert (generic, exceptional) == (known["generic"], known["exceptional"])


@pytest.mark.parametrize("kind", [[], ["json"], ["yaml"]])
def test_a_template_is_a_system_file_whose_keys_are_explained(kind: list[str]) -> None:
    status, out, _ = call("sample", "--template", *kind)
    assert status == 0
    place = "p.yaml" if kind == ["yaml"] else "p.json"
    system = read_any(out.encode(), place)
    assert system.names == ("pump", "valve") and system.neighbors is not None
    if kind != ["yaml"]:
        assert read_system(out) == system
    for key in ("time", "A", "channels", "neighbors", "delays", "sample_time", "name", "source"):
        assert f"{key}:" in out or f"{key} is" in out or f'"{key}": ' in out or f"{key} {{" in out


def test_a_template_is_not_drawn() -> None:
    status, _, said = call("sample", "--template", "--count", "2", "-o", "x")
    assert status == 2 and says(said, "template prints")
