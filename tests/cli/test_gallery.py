"""Published plants and starting files, which need no file."""

import json

import pytest

import mcexact
from mcexact.model import gallery
from mcexact.model.formats.recognize import read_any
from mcexact.model.system_file import read_system
from tests.cli.calling import call


def test_the_list_names_every_plant_with_its_source_and_what_it_shows() -> None:
    status, out, _ = call("gallery", "--json")
    assert status == 0
    plants = json.loads(out)["plants"]
    assert [plant["name"] for plant in plants] == list(gallery.names()) == list(mcexact.gallery())
    for plant in plants:
        system = mcexact.gallery(plant["name"])
        assert (plant["n"], plant["m"], plant["time"]) == (system.n, system.m, system.time)
        assert plant["source"] and plant["shows"] and "(-" not in plant["shows"]
        known = gallery.expected(plant["name"])
        assert plant["shows"].startswith("fixed: " if known["fixed_factors"] else "no fixed mode")
    status, out, _ = call("gallery")
    assert status == 0 and all(plant["name"] in out for plant in plants)


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
    assert status == 2 and "--template prints one file" in said
