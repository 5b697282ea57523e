# What people run who change the project: `make -f campaigns.mk NAME`, or `make NAME`.  Without a name
# the list is printed.  Times are those of two cores.

BIN := .venv/bin
STAMP := .venv/.installed
PIP := $(BIN)/python -m pip install --quiet --quiet --disable-pip-version-check

.PHONY: help agreement absence parameters hypersurfaces members every-question judged-sentences signals any-graph gaps periodic samples limited attack weakened-checker mutants readers damaged-files package-coverage checked-proofs weakened-proofs impossible-proofs verified-agreement paper-mutants bench designs boxes nearby digits costs six-loops rounding sentences schemas ledger records corpus wording durations matrix schemas-everywhere cluster look

# This list.
help:
	@awk '/^# / { text = text "    " substr($$0, 3) "\n"; next } \
	  /^## / { print "\n" substr($$0, 4) ":\n" } \
	  /^[a-z][a-z-]*:/ { sub(/:.*/, ""); print; printf "%s", text } { text = "" }' campaigns.mk

## Decisions, beside slower ways to decide

# Every decision beside exhaustive enumeration, on 10,000 drawn systems: minutes.
agreement: $(STAMP)
	$(BIN)/python -m tests.oracle.agreement 10000

# Both proofs that no more is fixed beside enumeration, on 10,000 drawn systems, and how often each
# was found: minutes.  The same command continues after an interruption.
absence: $(STAMP)
	$(BIN)/python -m tests.assurance.campaigns.absence $(or $(N),10000)

# Fixed modes for all values of a parameter, and what else is decided so, beside enumeration at 40
# points and modulo primes, on 1,000 drawn systems: a quarter of an hour.  The same command continues
# after an interruption.
parameters: $(STAMP)
	$(BIN)/python -m tests.assurance.campaigns.parametric $(or $(N),1000) $(or $(FIRST),0)

# Exceptional hypersurfaces of several parameters beside enumeration on other lines modulo primes, on
# 300 drawn systems: a quarter of an hour.  The same command continues after an interruption.
hypersurfaces: $(STAMP)
	$(BIN)/python -m tests.assurance.campaigns.hypersurfaces $(or $(N),300) $(or $(FIRST),0)

# What is proved for all plants in boxes of 3,000 drawn systems, beside exact decisions about members
# and segments: an hour.  The same command continues after an interruption.
members: $(STAMP)
	$(BIN)/python -m tests.assurance.campaigns.boxes $(or $(N),3000) $(or $(FIRST),0)

# Every question about 3,000 drawn plants (generic, with modes out of reach, with prescribed indices,
# sparse, in several components), all certificates checked and judged by exact elimination over Q: a
# quarter of an hour.  The same command continues after an interruption.
every-question: $(STAMP)
	$(BIN)/python -m tests.assurance.campaigns.every_question $(or $(N),3000) $(or $(FIRST),0)

# Which roots of signals are fixed with models of them at the agents, without messages and with shared
# states, beside the ranks of 1,000 drawn plants for all sets of agents: minutes.  The same command
# continues after an interruption.
signals: $(STAMP)
	$(BIN)/python -m tests.assurance.campaigns.signals $(or $(N),1000) $(or $(FIRST),0)

# Fixed modes of observers over any directed graph beside ranks for closed sets of agents, and of
# patterns of who uses which outputs beside ranks and drawn gains, on 700 drawn plants: minutes.  The
# same command continues after an interruption.
any-graph: $(STAMP)
	$(BIN)/python -m tests.assurance.campaigns.any_graph $(or $(N),700) $(or $(FIRST),0)

# Every sentence about 500 drawn plants and designs, judged by an oracle of its own from the plant
# alone, and which rules were never met: a quarter of an hour.  The same command continues after an
# interruption.
judged-sentences: $(STAMP)
	$(BIN)/python -m tests.assurance.campaigns.sentences $(or $(N),500) $(or $(FIRST),0)

# The paper's open question: every directed graph on 4 agents and 500 drawn ones beside brute force,
# with the plants that attain the factors; 10,000 drawn plants against the factors of their graphs;
# 1,000 with one deficient eigenvalue, by nested sets and by branch trees: a quarter of an hour, ten
# minutes, a minute.  PART=nested runs one of graphs, plants, nested.  The same command continues
# after an interruption.
gaps: $(STAMP)
	for part in $(or $(PART),graphs plants nested); do \
	  $(BIN)/python -m tests.assurance.campaigns.gaps $$part $(N) || exit 1; done

# Designs for 500 drawn plants over graphs that vary periodically, simulated step by step with messages
# really sent: minutes.  The same command continues after an interruption.
periodic: $(STAMP)
	$(BIN)/python -m tests.assurance.campaigns.periodic $(or $(N),500) $(or $(FIRST),0)

# Samples of 20,000 drawn plants within the radii that are computed for them: a minute.
# FILES='plant.json=1/10' designs for samples a step late instead.
samples: $(STAMP)
	$(BIN)/python -m benchmarks.samples $(FILES)

# Loops whose inputs are cut off at 40 % of what they ask for, with and without anti-windup: a minute.
# FILES='plant.json=1/10' takes the samples of other plants.
limited: $(STAMP)
	$(BIN)/python -m benchmarks.limited $(FILES)

## The checker under attack

# So many mutants and forgeries of certificates, judged by an oracle that is written from FORMAT.md
# alone: N=500000 takes minutes, N=5000000 an hour.  KINDS='parametric_fixed_spectrum
# parametric_rank' tries some kinds of certificates.
attack: $(STAMP)
	$(BIN)/python -m tests.assurance.attack $(or $(N),500000) $(if $(KINDS),--kinds $(KINDS))

# The campaign without each condition of the checker in turn; writes which holes were found: half an
# hour.  ONLY='spread periodic_loop' N=5000 leaves out the conditions of these functions, and writes
# their rows alone; KINDS=saturation tries some kinds.
weakened-checker: $(STAMP)
	$(BIN)/python -m tests.assurance.attack $(or $(N),200000) \
	  --weakened tests/assurance/attack/WEAKENED.md \
	  $(if $(ONLY),--functions $(ONLY)) $(if $(KINDS),--kinds $(KINDS))

# Mutation testing of the checker: every small change has to make one of these tests fail: half an hour.
# FILES='location rank' tries some files, and continues where an earlier run has ended; SAMPLE=100 tries
# so many changes of each file, the same ones in every run, MINUTES=15 stops after so many, and OWN=1
# runs the tests of these files alone, which takes a minute in place of ten before the first.  After it
# `python -m tests.assurance.mutants.search STEM` looks for documents that tell such changes from the
# checker, and keeps them for the tests.
mutants: $(STAMP)
	$(PIP) --editable '.[mutants]'
	HYPOTHESIS_PROFILE=ci $(BIN)/python -m tests.assurance.mutants $(FILES) \
	  $(if $(SAMPLE),--sample $(SAMPLE)) $(if $(MINUTES),--minutes $(MINUTES)) $(if $(OWN),--own)

# The package's readers of system files and controller files beside the checker's, on 120,000 drawn
# and damaged files: minutes.
readers: $(STAMP)
	$(BIN)/python -m tests.assurance.campaigns.grammar 100000
	$(BIN)/python -m tests.assurance.campaigns.controller_grammar 20000

# So many damaged files of each format, .mat, .npz, CSV, YAML and JSON, in processes with limits: none
# ends one, is not refused in words, or takes five seconds: ten minutes.  The same command continues
# after an interruption; FIRST=200 draws other files, in batches of 100.
damaged-files: $(STAMP)
	$(BIN)/python -m tests.assurance.campaigns.damaged_files $(or $(N),20000) $(or $(FIRST),0)

# Which lines and branches of the whole package the tests run, reported and not demanded, with pages in
# build/package-coverage: an hour.  TESTS='tests/exact tests/model' runs some.
package-coverage: $(STAMP)
	$(BIN)/coverage run --rcfile= --branch --source=mcexact --data-file=build/package-coverage.data \
	  -m pytest --quiet $(TESTS)
	$(BIN)/coverage html --rcfile= --quiet --data-file=build/package-coverage.data --directory=build/package-coverage
	$(BIN)/coverage report --rcfile= --skip-covered --sort=cover --data-file=build/package-coverage.data

## Proofs

# The compiled proofs once more, by Coq's independent checker: minutes.
checked-proofs:
	@$(MAKE) --no-print-directory -C proofs all check

# Every rule of the checker with one hypothesis weakened: each proof has to fail.
weakened-proofs:
	@$(MAKE) --no-print-directory -C proofs weakened

# Ten theorems of paper.v with a hypothesis that nothing satisfies: each has to be refused.
impossible-proofs:
	@$(MAKE) --no-print-directory -C proofs impossible

# Mutants and forgeries of their common kinds, judged by the checker and by mcexact-verified: minutes.
# KINDS='setpoint completeness' tries some.
verified-agreement: $(STAMP)
	$(BIN)/python -m tests.assurance.campaigns.verified $(or $(N),10000) $(KINDS)

# Changes of the examinations behind `reproduce`, each of which has to make one fail: minutes.
paper-mutants: $(STAMP)
	$(BIN)/python -m tests.assurance.paper_mutants

## Figures, and how long things take

# Ratios to peers, measured in one run, and how commands grow: half an hour.  PARTS=quick takes a
# minute, PARTS='absence command' those parts; what is kept in benchmarks/rows is not measured again.
bench: $(STAMP)
	$(BIN)/python -m benchmarks $(PARTS)

# Designs for published plants and for families of plants: an hour.  Rows that are kept in
# benchmarks/rows are not measured again.  Writes benchmarks/DESIGNS.md.
designs: $(STAMP)
	$(BIN)/python -m benchmarks.gallery_designs
	$(BIN)/python -m benchmarks.families
	$(BIN)/python -m benchmarks.one_agent

# What is proved for every plant in a box, of the published plants: half an hour.  PARTS='members size'
# measures some; a folder of further system files can be among them.
boxes: $(STAMP)
	$(BIN)/python -m benchmarks.boxes $(PARTS)

# Plants nearby of which an answer is another one: how many are found, and how long that takes: minutes.
nearby: $(STAMP)
	$(BIN)/python -m benchmarks.nearby $(PARTS)

# How many digits of the gains of designed controllers are safe, and how many are too few: minutes.
# NAMES='theorem compleib-ac1' tries some; a folder of further system files can be among them.
digits: $(STAMP)
	$(BIN)/python -m benchmarks.digits $(NAMES)

# Costs of drawn controllers beside the certified bound: a minute.  Writes benchmarks/COSTS.md.
costs: $(STAMP)
	$(BIN)/python -m benchmarks.costs

# Bytes and seconds of the proofs of cost and margins of six loops: ten minutes.  PLANTS=chain-10 tries some.
# Writes benchmarks/LOOPS.md.
six-loops: $(STAMP)
	$(BIN)/python -m benchmarks.six_loops $(PLANTS)

# How many numbers each rounding of floats recovers: a minute.  Writes benchmarks/ROUNDING.md.
rounding: $(STAMP)
	$(BIN)/python -m benchmarks.rounding

## Files that programs write, and that are kept

# The list of all sentences that the commands print about a system, from their templates.
sentences: $(STAMP)
	$(BIN)/python -m mcexact.answer.listing

# The JSON Schemas of files and of --json, from their declarations: seconds.
schemas: $(STAMP)
	$(BIN)/python -m mcexact.report.schema

# The tables of the paper's statements, of what is open, and of the examinations in proofs/.
ledger: $(STAMP)
	$(BIN)/python proofs/ledger_table.py
	$(BIN)/python proofs/reading_order.py

# What floating point answers wrongly on this machine, recorded beside the exhibits.
records: $(STAMP)
	$(BIN)/python -m mcexact.crosschecks.recording

# Certificates, and what each rule for sentences makes of them, as tests/checker compares: minutes.
corpus: $(STAMP)
	$(BIN)/python -m tests.checker.corpus_sentences

# The words of messages and sentences that tests compare, recorded in tests/wording.txt by running
# these tests: minutes.  PATHS='tests/cli/test_designs.py' records those of some.
wording: $(STAMP)
	$(BIN)/python -m tests.wording $(PATHS)

## The tests and what they run on

# Which tests take more than 0.5 seconds of the processor, measured one after another and written to
# tests/slow.txt: half an hour.  PATHS='tests/synthesis' measures some.
durations: $(STAMP)
	$(BIN)/python -m tests.durations $(PATHS)

# The full tests under every kernel, Python and library version that they have to pass with: an hour
# or more. CELLS='oldest python3.*' runs some; PYTHONS holds interpreters that are not on PATH.
matrix: $(STAMP)
	$(BIN)/python -m tests.matrix $(foreach cell,$(CELLS),'$(cell)')

# All JSON of all commands about every published plant, against these schemas: half an hour.
# NAMES='quadruple-tank-pminus' tries some. What build/schemas.jsonl holds is not tried again.
schemas-everywhere: $(STAMP)
	$(BIN)/python -m tests.assurance.campaigns.schemas $(NAMES)

# A sweep of 2,000 systems over a dask cluster of two processes, of which one is killed: minutes.
cluster: $(STAMP)
	$(BIN)/python -m tests.assurance.campaigns.cluster $(or $(N),2000)

# The reports in a browser, at two widths, light and dark; screenshots in build/look/.
look: $(STAMP)
	@command -v chromium >/dev/null || command -v google-chrome >/dev/null || \
	  { apt-get update -qq && \
	    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends chromium >/dev/null; } || \
	  { echo "look: Chromium is missing and cannot be installed" >&2; exit 1; }
	$(BIN)/python -m tests.assurance.look build/look

$(STAMP): pyproject.toml
	@$(MAKE) --no-print-directory $@
