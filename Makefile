# Atoll: `make run` and `make test` are all that a fresh machine needs (Debian with Python 3.11 or newer, and make).

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
RUN_READY := $(VENV)/.ready-run
TEST_READY := $(VENV)/.ready-test

.PHONY: run test torture lint bench peers lock clean help

help:            ## say what there is
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed 's/:.*##/\t/' | expand -t 18

run: $(RUN_READY)  ## run the main job and say where its results are
	@$(BIN)/atoll run experiments/archipelago.yaml

test: $(TEST_READY)  ## checkers, then the test suite
	@$(MAKE) --no-print-directory lint
	@$(BIN)/python -m pytest -q -n 2

lint: $(TEST_READY)  ## ruff, mypy strict, import-linter
	@$(BIN)/ruff check
	@$(BIN)/ruff format --check
	@$(BIN)/mypy
	@$(BIN)/lint-imports

torture: $(TEST_READY)  ## the fault suite whole, and its table (minutes)
	@ATOLL_TORTURE=1 $(BIN)/python -m pytest -q tests/torture -m "torture or ray"

bench: $(TEST_READY) peers  ## benchmarks, as ratios against peers, and the table in docs/bench.md
	@$(BIN)/python -m benchmarks

peers:           ## an environment of its own for the engines that benchmarks compare with
	@test -x .venv-peers/bin/python || PYTHON="$(PYTHON)" sh scripts/venv.sh .venv-peers
	@.venv-peers/bin/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements-peers.lock

lock: $(TEST_READY)  ## write the lock files anew
	@sh scripts/lock.sh

clean:           ## remove the environment and what tools left
	rm -rf $(VENV) .venv-peers .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache build dist

$(BIN)/python:
	@PYTHON="$(PYTHON)" sh scripts/venv.sh $(VENV)

$(RUN_READY): requirements.lock pyproject.toml | $(BIN)/python
	@echo "Installing the pinned packages ..."
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements.lock
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	@echo "Compiling the kernels ..."
	@$(BIN)/python -m growth.warm && $(BIN)/python -m evaluators.blocks.warm && $(BIN)/python -m evaluators.symbiosis.warm \
		&& $(BIN)/python -m evaluators.plans.warm
	@touch $@

$(TEST_READY): $(RUN_READY) requirements-dev.lock
	@echo "Installing the checkers and test tools ..."
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements-dev.lock
	@touch $@
