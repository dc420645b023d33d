# Commands for people. Each target sets up what it requires; nothing has to be activated.

PYTHON ?= python3
VENV   ?= .venv
BIN    := $(VENV)/bin
SECONDS ?= 30 # of fuzzing
C := $(filter-out $(wildcard lib*/evoframe_*/*.c),$(wildcard lib*/*.[ch] lib*/*/*.[ch])) # without the files that cffi generates
SOURCES := pyproject.toml setup.py extensions.py $(C) $(wildcard lib*/*/*.py)
PARALLEL := --numprocesses auto --dist worksteal

LOWEST := $(VENV)-lowest
LONG   := interpreters

.PHONY: run test long lint types imports unit lowest browser sanitize fuzz interpreters clean

## run: the published experiment
run: $(VENV)/installed
	$(BIN)/evoframe run

## test: everything that CI checks
test: lint types imports unit lowest browser sanitize fuzz
	@echo "not run: make long ($(LONG))"

## long: evidence that takes too long for every change
long: $(LONG)

## lint: style of the Python and the C code
lint: $(VENV)/developing
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/clang-format --dry-run --Werror $(C)

## types: mypy --strict
types: $(VENV)/developing
	$(BIN)/mypy

## imports: layers of packages
imports: $(VENV)/developing
	$(BIN)/lint-imports

## unit: the tests, on all cores, with the coverage of the code
unit: $(VENV)/developing
	$(BIN)/coverage erase
	$(BIN)/coverage run -m pytest $(PARALLEL)
	$(BIN)/coverage combine --quiet
	$(BIN)/coverage report

## lowest: the tests, with the lowest version of each dependency that pyproject.toml allows
lowest: $(LOWEST)/developing
	$(LOWEST)/bin/python -m pytest -W ignore::DeprecationWarning $(PARALLEL) # old releases use deprecated functions of newer ones

## browser: the pages of reports, in Chromium
browser: $(VENV)/developing
	PYTHON=$(BIN)/python tests/browser/browser.sh

## sanitize: the C libraries and their tests under the address and undefined-behavior sanitizers
sanitize: $(VENV)/developing
	PYTHON=$(BIN)/python tests/sanitize.sh

## interpreters: the tests, with each other Python that is installed
interpreters: $(VENV)/developing
	PYTHON=$(BIN)/python tests/interpreters.sh $(PARALLEL)

## fuzz: SECONDS of random inputs for libvox and the readers of VXA files and configurations
fuzz: $(VENV)/fuzzing
	PYTHON=$(BIN)/python tests/fuzz/fuzz.sh $(SECONDS)

clean:
	rm -rf $(VENV) $(LOWEST) .coverage .coverage.* build dist *.egg-info $(wildcard lib*/evoframe_lib*/_*.c lib*/evoframe_lib*/_*.so)

$(BIN)/python:
	$(PYTHON) -m venv $(VENV)

$(VENV)/installed: $(BIN)/python $(SOURCES)
	$(BIN)/python -m pip install --quiet --upgrade 'pip>=25.1' # first version with dependency groups
	$(BIN)/python -m pip install --quiet --editable '.[report]'
	touch $@

$(VENV)/developing: $(VENV)/installed
	$(BIN)/python -m pip install --quiet --group dev
	touch $@

# Without isolation, so that the C libraries are also built with the lowest versions.
$(LOWEST)/developing: $(VENV)/developing
	$(BIN)/uv venv --quiet --clear --python $(BIN)/python $(LOWEST)
	$(BIN)/uv pip install --quiet --python $(LOWEST) --resolution lowest-direct \
		--requirements pyproject.toml --all-extras --group tests
	$(BIN)/uv pip install --quiet --python $(LOWEST) --no-deps --no-build-isolation --editable .
	touch $@

$(VENV)/fuzzing: $(VENV)/developing
	$(BIN)/python -m pip install --quiet 'atheris>=3,<4'
	touch $@
