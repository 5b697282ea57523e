# Needs python3, make and a package registry that pip can reach; everything else goes into .venv.

PYTHON ?= python3
BIN := .venv/bin
STAMP := .venv/.installed
GALLERY := mcexact/model/gallery

.PHONY: demo test lint types tests agreement bench

demo: $(STAMP)
	$(BIN)/mcexact demo
	$(BIN)/mcexact analyze $(GALLERY)/liu2020-3ch-no-communication.json
	$(BIN)/mcexact analyze $(GALLERY)/quadruple-tank-pminus.json

test: lint types tests

lint: $(STAMP)
	$(BIN)/ruff format --quiet --check .
	$(BIN)/ruff check --quiet .

types: $(STAMP)
	$(BIN)/mypy --strict mcexact

tests: $(STAMP)
	HYPOTHESIS_PROFILE=ci $(BIN)/python -m pytest --quiet --numprocesses 2 --dist loadscope

# Every decision beside exhaustive enumeration, on 10,000 drawn systems: minutes.
# Ratios to peers, measured in one run; the figures also go to bench.json.
bench: $(STAMP)
	$(BIN)/python -m benchmarks bench.json

agreement: $(STAMP)
	$(BIN)/python -m tests.oracle.agreement 10000

$(STAMP): pyproject.toml
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --quiet --disable-pip-version-check --editable '.[dev]'
	touch $(STAMP)
