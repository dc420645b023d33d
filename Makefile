# Commands for users and developers. Each target sets up its environment; no environment has to be activated.

PYTHON ?= python3
VENV   ?= .venv
BIN    := $(VENV)/bin
SECONDS ?= 30 # of fuzzing
C := $(filter-out $(wildcard lib*/evoframe_*/*.c),$(wildcard lib*/*.[ch] lib*/*/*.[ch])) # without files of cffi
SOURCES := pyproject.toml setup.py extensions.py $(C) $(wildcard lib*/*/*.py)
PARALLEL := --numprocesses auto --dist worksteal

LOWEST := $(VENV)-lowest
VERSIONLESS := tests/survival tests/cli/test_streams.py tests/cli/test_signals.py # depend on no version
VERSIONLESS += tests/architecture/test_third_party_runs.py tests/experiment/test_functions.py
LONG   := interpreters kills latex hunt

.PHONY: run test long lint types imports unit lowest browser sanitize fuzz interpreters kills latex hunt clean

## run: run the published experiment (preset paper)
run: $(VENV)/installed
	$(BIN)/evoframe run

## test: run all checks of CI
test: lint types imports unit lowest browser sanitize fuzz
	@echo "not run: make long ($(LONG))"

## long: run the checks that take too long for every change
long: $(LONG)

## lint: check the style of the Python and C code
lint: $(VENV)/developing
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/clang-format --dry-run --Werror $(C)

## types: check types with mypy --strict
types: $(VENV)/developing
	$(BIN)/mypy

## imports: check which packages import each other
imports: $(VENV)/developing
	$(BIN)/lint-imports

## unit: run the tests on all cores, and measure their coverage
unit: $(VENV)/developing
	$(BIN)/coverage erase
	$(BIN)/coverage run -m pytest $(PARALLEL)
	$(BIN)/coverage combine --quiet
	$(BIN)/coverage report

## lowest: run the tests with the lowest version of each dependency that pyproject.toml allows
lowest: $(LOWEST)/developing
	@# old releases use deprecated functions
	$(LOWEST)/bin/python -m pytest -W ignore::DeprecationWarning $(PARALLEL) $(VERSIONLESS:%=--ignore=%)
	@echo "lowest: not repeated: $(VERSIONLESS)"

## browser: test the pages of reports in Chromium
browser: $(VENV)/developing
	PYTHON=$(BIN)/python tests/browser/browser.sh

## sanitize: test the C libraries with the address and undefined-behavior sanitizers
sanitize: $(VENV)/developing
	PYTHON=$(BIN)/python tests/sanitize.sh

## interpreters: run the tests with each other installed version of Python
interpreters: $(VENV)/developing
	PYTHON=$(BIN)/python tests/interpreters.sh $(PARALLEL)

## kills: kill hundreds of runs, and of workers while they start, on a quiet and on a busy computer
kills: $(VENV)/developing
	$(BIN)/python tests/survival/kills.py --kills 500
	$(BIN)/python tests/survival/worker_kills.py --kills 400
	$(BIN)/python tests/survival/worker_kills.py --kills 400 --seed 1000 --busy 2

## hunt: look for ten minutes for bodies whose samples depend on what the solver leaves out
hunt: $(VENV)/developing
	$(BIN)/python tests/libvox/hunt.py 600

## latex: typeset tables of reports
latex: $(VENV)/developing
	PYTHON=$(BIN)/python tests/latex/latex.sh

## fuzz: fuzz libvox and the readers of VXA files and configurations for SECONDS
fuzz: $(VENV)/fuzzing
	PYTHON=$(BIN)/python tests/fuzz/fuzz.sh $(SECONDS)

clean:
	rm -rf $(VENV) $(LOWEST) .coverage .coverage.* build dist *.egg-info $(wildcard lib*/evoframe_lib*/_*.c lib*/evoframe_lib*/_*.so)

$(BIN)/python:
	$(PYTHON) -m venv $(VENV)

$(VENV)/installed: $(BIN)/python $(SOURCES)
	$(BIN)/python -m pip install --quiet --upgrade 'pip>=25.1' # the first with dependency groups
	$(BIN)/python -m pip install --quiet --editable '.[report]'
	touch $@

$(VENV)/developing: $(VENV)/installed
	$(BIN)/python -m pip install --quiet --group dev
	touch $@

# No build isolation, so that the C libraries are also built with the lowest versions.
$(LOWEST)/developing: $(VENV)/developing
	$(BIN)/uv venv --quiet --clear --python $(BIN)/python $(LOWEST)
	$(BIN)/uv pip install --quiet --python $(LOWEST) --resolution lowest-direct \
		--requirements pyproject.toml --all-extras --group tests
	$(BIN)/uv pip install --quiet --python $(LOWEST) --no-deps --no-build-isolation --editable .
	touch $@

$(VENV)/fuzzing: $(VENV)/developing
	$(BIN)/python -m pip install --quiet 'atheris>=3,<4'
	touch $@
