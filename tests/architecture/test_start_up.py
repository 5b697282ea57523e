"""Starting is quick: what is heavy is imported where it is used."""

import subprocess
import sys

import pytest

import mcexact

HEAVY = (
    *("sympy", "scipy", "matplotlib", "networkx", "control", "numpy", "flint", "jinja2"),
    *("pandas", "hypothesis", "dask", "distributed"),
)
LOADED = f"import sys; print([name for name in {HEAVY!r} if name in sys.modules])"


def loaded_after(statement: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", f"{statement}; {LOADED}"],
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.splitlines()[-1]


def test_importing_the_package_loads_nothing_heavy() -> None:
    assert loaded_after("import mcexact; dir(mcexact)") == "[]"


def test_the_help_of_the_command_line_loads_nothing_heavy() -> None:
    call = (
        "from mcexact.cli import command_line; command_line.main(['--help'], standalone_mode=False)"
    )
    assert loaded_after(call) == "[]"


@pytest.mark.parametrize("name", ["", "c"])
def test_listing_and_completing_commands_loads_none_of_them(name: str) -> None:
    statement = (
        "import click; from mcexact.cli import command_line; "
        f"command_line.shell_complete(click.Context(command_line), {name!r}); "
        "click.Context(command_line).get_help(); "
        "import sys; assert not {f'mcexact.cli.{each.place.partition(\":\")[0]}' "
        "for each in command_line.listed.values()} & sys.modules.keys()"
    )
    assert loaded_after(statement) == "[]"


@pytest.mark.parametrize("command", ["analyze", "allocate", "certify", "design", "simulate"])
def test_what_waits_for_a_child_loads_no_library_with_threads(command: str) -> None:
    loaded = loaded_after(f"import mcexact.cli.{command}")
    assert not {"'numpy'", "'scipy'", "'matplotlib'"} & set(loaded.strip("[]").split(", "))


def test_a_name_that_is_not_exported_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match=r"mcexact.*nothing"):
        mcexact.nothing  # type: ignore[attr-defined]  # noqa: B018


def test_a_system_is_made_without_the_symbolic_and_the_plotting_libraries() -> None:
    made = "import mcexact; mcexact.MultiChannelSystem([[1]], [[[1]]], [[[1]]])"
    loaded = loaded_after(made)
    assert not {"'sympy'", "'scipy'", "'matplotlib'"} & set(loaded.strip("[]").split(", "))


@pytest.mark.parametrize("neighbors", ["None", "NeighborGraph.ring(['1', '2'])"])
def test_the_questions_about_numbers_load_nothing_for_graphs_or_parameters(neighbors: str) -> None:
    answered = (
        "from mcexact import MultiChannelSystem, NeighborGraph, analyze; "
        "ports = [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]]; "
        f"plant = MultiChannelSystem([[0, 1], [1, 0]], *ports, neighbors={neighbors}); "
        "account = analyze(plant, nearby=False).account; account.explain(); account.files(); "
        "import sys; "
        "assert not [x for x in sys.modules if x.startswith('mcexact.analysis.parameters')]"
    )
    loaded = set(loaded_after(answered).strip("[]").split(", "))
    assert not {"'networkx'", "'numpy'", "'scipy'"} & loaded
