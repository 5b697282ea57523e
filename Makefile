# Needs python3, make and a package registry that pip can reach; everything else goes into .venv.
# What people run who change the project is in campaigns.mk: `make -f campaigns.mk` lists it, and any
# name of it can be given here, too.

PYTHON ?= python3
BIN := .venv/bin
CORE := .venv/.core
STAMP := .venv/.installed
DOCS := build/docs/environment
PIP := $(BIN)/python -m pip install --quiet --quiet --disable-pip-version-check
GALLERY := mcexact/model/gallery
# Tests that are repeatable, in two processes that multiply in one thread each, and whose many short
# programs are compiled once.
ONCE := HYPOTHESIS_PROFILE=$(or $(HYPOTHESIS_PROFILE),ci) OPENBLAS_NUM_THREADS=$(or $(OPENBLAS_NUM_THREADS),1) PYTHONDONTWRITEBYTECODE=

.PHONY: demo test lint types tests slow-tests coverage docs generated reproduce proofs verified zipapp release

demo: $(CORE)
	$(BIN)/mcexact demo
	@echo
	$(BIN)/mcexact analyze $(GALLERY)/liu2020-3ch-no-communication.json
	@echo
	$(BIN)/mcexact analyze $(GALLERY)/quadruple-tank-pminus.json
	@echo
	@echo "The command mcexact is in .venv/bin. This line puts it on your path:"
	@echo "    export PATH=\"$(CURDIR)/.venv/bin:\$$PATH\""

test: lint types tests

lint: $(STAMP)
	$(BIN)/ruff format --quiet --check .
	$(BIN)/ruff check --quiet .

types: $(STAMP)
	$(BIN)/mypy

tests: $(STAMP)
	$(ONCE) $(BIN)/python -m pytest --quiet --numprocesses 2 --dist worksteal -m 'not slow'

# The tests that `make tests` leaves out, because each of them takes seconds: together they are all.
slow-tests: $(STAMP)
	$(ONCE) $(BIN)/python -m pytest --quiet --numprocesses 2 --dist worksteal -m slow

# Every line and branch of the checker is run by the tests of its own folder: minutes.
coverage: $(STAMP)
	$(BIN)/coverage run --rcfile=pyproject.toml -m pytest --quiet tests/checker
	$(BIN)/coverage report --rcfile=pyproject.toml

# The documentation in build/docs/html, in an environment of its own; every warning is an error, and
# the notebooks are executed: minutes.
docs: $(DOCS)/.installed
	$(DOCS)/bin/sphinx-build --quiet --fail-on-warning --keep-going -b html docs build/docs/html
	@echo "The documentation is in build/docs/html/index.html"

# The files that programs write and that are kept: sentences, schemas, and the tables in proofs/.
generated:
	@$(MAKE) --no-print-directory -f campaigns.mk sentences schemas ledger

# What is known of every statement of the paper, with a report and certificates in reproduction/:
# less than a minute.
reproduce: $(STAMP)
	$(BIN)/mcexact reproduce -o reproduction

# Installs Coq where it is missing and where it may, compiles every proof, and demands that no
# theorem rests on an axiom: minutes.
proofs:
	@$(MAKE) --no-print-directory -C proofs all

# The program mcexact-verified: extracted from the kernel of proofs/kernel, compiled, and put beside the
# command.  Installs Coq, OCaml and Zarith where they are missing and where it may: minutes.
verified: $(CORE)
	@$(MAKE) --no-print-directory -C verified BIN=$(abspath $(BIN))

# The checker alone as one file, which `python -I` runs: seconds.
zipapp: $(STAMP)
	mkdir -p dist
	$(BIN)/mcexact check --export dist/mcexact-checker.pyz

# Wheel and source distribution in dist/, built twice and compared, checked, installed in a new
# environment, and used as the tutorial does: minutes.
release: $(STAMP)
	$(PIP) --editable '.[release]'
	$(BIN)/python -m tests.assurance.release

# What a user needs, without what draws, tests or documents.
$(CORE): pyproject.toml
	@echo "Making an environment in .venv, and installing mcexact with the libraries of its core"
	@echo "(numpy, scipy, sympy, networkx, python-flint and others, 400 MB): one to three minutes ..."
	@$(PYTHON) -m venv .venv
	@$(PIP) --editable .
	@touch $(CORE)

$(STAMP): $(CORE)
	@echo "Installing what the tests need, too: one to three minutes ..."
	@$(PIP) --editable '.[dev]'
	@touch $(STAMP)

$(DOCS)/.installed: pyproject.toml
	@echo "Installing what the documentation needs into $(DOCS): one to three minutes ..."
	@$(PYTHON) -m venv $(DOCS)
	@$(DOCS)/bin/python -m pip install --quiet --quiet --disable-pip-version-check --editable '.[docs]'
	@touch $@

.DEFAULT:
	@$(MAKE) --no-print-directory -f campaigns.mk $@
