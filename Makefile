# sfgen: `make help` lists what there is. Each target makes .venv first when it is missing or out of date.
#
# PRESET=smoke|quick|full|paper  works on a scratch clone in build/<preset>, so that no tracked file changes
# PYTHON=python3.12              the interpreter that .venv is made with (CPython 3.11 or newer)
# TORCH_INDEX=URL                a package index for torch alone, such as PyTorch's CPU index
# START=scratch                  `make weights` trains from nothing, not from what lies in weights/: three hours
# JOBS=2                         processes of the tests

SHELL := bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.PHONY: run test engines check deps bench weights clean help

PRESET ?=
START ?= released
TORCH_INDEX ?=
JOBS ?= 2
PYTHON ?= $(shell for p in python3.11 python3.12 python3.13 python3 python; do \
	$$p -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$p && break; done)

BIN := $(CURDIR)/.venv/bin
READY := .venv/.ready
DEV := .venv/.dev
SCRATCH := build/$(PRESET)
export PATH := $(BIN):$(PATH)
export PIP_DISABLE_PIP_VERSION_CHECK := 1
export DVC_NO_ANALYTICS := 1

run: $(READY) ## the whole factory: installs, runs every stage, says where dataset, report and pictures lie
ifeq ($(PRESET),)
	nice python -m stages.warm & dvc repro
	python -m stages.doctor --places
else
	python .ci/scratch.py $(SCRATCH) $(PRESET)
	cd $(SCRATCH) && { nice python -m stages.warm & dvc repro && python -m stages.doctor --places; }
endif

test: $(DEV) ## all tests
	OMP_NUM_THREADS=1 python -m pytest -n $(JOBS)

# without what they only draw and convert with (OpenCV, embreex, by which trimesh would shoot rays otherwise than the factory's)
engines: $(DEV) ## SAPIEN and yourdfpy for the tests that want them: 7 s, 140 MB
	@python -m pip install --quiet --no-compile --no-deps -c constraints.txt 'sapien>=3.0,<4' 'yourdfpy>=0.0.60' transforms3d lxml \
		|| { echo "sfgen: no package index that can be reached has SAPIEN and yourdfpy; without them \`make test\` skips what wants them" >&2; exit 1; }

check: $(DEV) ## format, lint, types, imports
	ruff format --check
	ruff check
	mypy
	lint-imports --no-logo

deps: $(DEV) ## write the code that each stage runs into dvc.yaml
	python .ci/deps.py --write

bench: $(DEV) ## every benchmark in benchmarks/
	failed=; for file in benchmarks/*.py; do echo "== $$file"; PYTHONPATH=. python $$file || failed="$$failed $$file"; done; test -z "$$failed" || { echo "failed:$$failed"; exit 1; }

# with a PRESET they stay in its clone
weights: $(READY) ## train the released weights further, into weights/: an hour; a killed run goes on
	python .ci/scratch.py build/$(or $(PRESET),release) $(or $(PRESET),release) $(START)
	cd build/$(or $(PRESET),release) && dvc repro train
	$(if $(PRESET),,cp build/$(or $(PRESET),release)/models/{vae,denoiser}.safetensors weights/)

clean: ## scratch clones and caches; what DVC made stays
	rm -rf build .pytest_cache .mypy_cache .ruff_cache .import_linter_cache .hypothesis
	find . -name __pycache__ -not -path './.venv/*' -prune -exec rm -rf {} +

help: ## this list
	@awk -F ':.*## ' '/^[a-z]+:.*## / {printf "  make %-7s %s\n", $$1, $$2} /^# [A-Z_]+=/ {sub(/^# /, "    "); print}' Makefile

$(READY): pyproject.toml constraints.txt
	@test -n "$(PYTHON)" || { echo "sfgen: no CPython 3.11 or newer is found; install one, or give PYTHON=/path/to/python" >&2; exit 1; }
	@# from inside an activated .venv, venv must be made by the Python that it was made from
	test -x .venv/bin/python || "$$($(PYTHON) -c 'import sys; print(sys._base_executable)')" -m venv .venv
	$(if $(TORCH_INDEX),python -m pip install --quiet --no-compile -c constraints.txt --index-url $(TORCH_INDEX) torch)
	@# without byte code: of most modules nobody asks, and compiling all takes longer than unpacking them
	python -m pip install --quiet --no-compile -c constraints.txt -e '.[factory,render]'
	touch $@

$(DEV): $(READY)
	python -m pip install --quiet --no-compile -c constraints.txt -e '.[factory,render,dev]'
	touch $@
