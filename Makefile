# `make demo` runs the main job, `make test` passes the tests; both set up everything they need.
# The distribution's own Python where it will do; PYTHON=python3.X takes another one.
PYTHON ?= $(shell tools/find_python.sh)
VENV := .venv
BIN := $(VENV)/bin
DANCETUTOR := $(BIN)/dancetutor
DEMO := build/demo
SHARED ?= ../shared
DEV_SHARED := build/shared

# The project's own bytecode and numba caches stay in the checkout; nothing is written elsewhere.
export PIP_DISABLE_PIP_VERSION_CHECK := 1

.PHONY: help wheel install-check page-tools setup setup-dev demo test lint bench fit fit-meter motion-report character site gallery docs-pictures docs-figures clean

help:
	@echo "make demo    analyze, annotate, animate and render the demo song into $(DEMO)/"
	@echo "make test    run the tests (sets up the development tools too)"
	@echo "make lint    ruff and mypy --strict"
	@echo "make fuzz    broken input for every reader, MINUTES=10; finds go to tests/data/fuzz/"
	@echo "make kill-test  end annotate, render and analyze at KILLS=300 random moments; nothing may be lost"
	@echo "make bench   measure speed; print a table"
	@echo "make motion-report  the quality of the motion on sections of COUNT=100 charts; a table in build/"
	@echo "make fit     fit the presets itg and pump to labelled feet; the table of all sets, by method"
	@echo "make fit-meter  fit configs/meter/ to the charts in CHARTS=folder, configs/score.yaml to TIERS=table; songs not seen"
	@echo "make setup   only set up $(VENV)"
	@echo "make character  build the dancer and the mannequin of the package again, byte for byte"
	@echo "make site    the documents as a web site with search, in build/site/; strict about links"
	@echo "make gallery  ten films, sheets and pages of free songs with an index, in build/gallery/; run again to continue"
	@echo "make docs-pictures  draw the pictures of README and docs again"
	@echo "make docs-figures   measure the tables of docs again; FIGURES='motion physics' those of two pages"
	@echo "make page-tools  TypeScript and axe for the tests of the practice page, with npm"
	@echo "make wheel   a wheel for this Python and platform with compiled kernels, in dist/"
	@echo "make install-check  the wheel by pipx and uvx in an empty home, as a user would; needs a package registry"
	@echo "make clean   remove $(VENV), build/ and caches"

setup: $(VENV)/.runtime

setup-dev: $(VENV)/.dev

$(BIN)/python:
	$(eval PYTHON := $(PYTHON))
	@test -n "$(PYTHON)"
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "dancetutor needs Python 3.11 or newer; set PYTHON=python3.X" >&2; exit 1; }
	@$(PYTHON) -c 'import venv, ensurepip' 2>/dev/null || \
	  { echo "Python's venv is missing. Debian/Ubuntu: apt-get install python3-venv" >&2; exit 1; }
	$(PYTHON) -m venv $(VENV)

$(VENV)/.runtime: requirements.lock pyproject.toml | $(BIN)/python
	@if [ -e $(VENV)/.dev ]; then :; else $(BIN)/pip install --quiet --require-hashes -r requirements.lock; fi
	@$(BIN)/pip install --quiet --no-deps -e .
	@touch $@

$(VENV)/.dev: requirements-dev.lock requirements.lock pyproject.toml | $(BIN)/python
	@$(BIN)/pip install --quiet --require-hashes -r requirements-dev.lock
	@$(BIN)/pip install --quiet --no-deps -e .
	@touch $@ $(VENV)/.runtime

demo: setup
	@$(BIN)/python tools/demo.py $(DEMO)

test: setup-dev
	@tools/gl_packages.sh
	$(BIN)/python -m pytest -n 2 --dist loadfile $(PYTEST_ARGS)

lint: setup-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

# Its own environment, so that the versions that shaped the dancer are pinned and nothing else needs them.
build/venv-character/.ready: requirements-character.lock pyproject.toml | $(BIN)/python
	$(PYTHON) -m venv build/venv-character
	@build/venv-character/bin/pip install --quiet --require-hashes -r requirements-character.lock
	@build/venv-character/bin/pip install --quiet --no-deps -e .
	@touch $@

character: build/venv-character/.ready
	@build/venv-character/bin/python research/build_character.py

# Its own environment: nothing else needs what builds the site.
build/venv-site/.ready: requirements-site.lock | $(BIN)/python
	$(PYTHON) -m venv build/venv-site
	@build/venv-site/bin/pip install --quiet --require-hashes -r requirements-site.lock
	@touch $@

site: setup build/venv-site/.ready
	@$(BIN)/python tools/site.py build/site-source
	@NO_MKDOCS_2_WARNING=1 build/venv-site/bin/mkdocs build --strict
	@echo "build/site: $$(ls build/site/*.html | wc -l) pages; to read and search them: python3 -m http.server -d build/site"

gallery: setup
	@$(BIN)/python tools/gallery.py build/gallery

docs-pictures: setup
	@$(BIN)/python tools/doc_pictures.py

docs-figures: setup-dev
	@OMP_NUM_THREADS=1 $(BIN)/python tools/doc_figures.py $(FIGURES)

bench: setup-dev
	@$(BIN)/python tools/bench.py $(BENCH_ARGS)

MINUTES ?= 10
fuzz: setup-dev
	@$(BIN)/python tools/fuzz.py --minutes $(MINUTES) $(FUZZ_ARGS)

KILLS ?= 300
kill-test: setup-dev
	@$(BIN)/python tools/kill_test.py --count $(KILLS)

fit: setup-dev
	@$(BIN)/python research/fit_weights.py $(FIT_ARGS)

# CHARTS: a folder of charts whose meters are to be learned; TIERS: a table of how hard some of them are to score on
fit-meter: setup-dev
	@$(BIN)/python research/fit_meter.py $(CHARTS) $(if $(TIERS),--tiers $(TIERS)) $(FIT_ARGS)

COUNT ?= 100
motion-report: setup-dev
	@$(BIN)/python tools/motion_report.py --count $(COUNT) $(REPORT_ARGS)

wheel: setup-dev
	HATCH_BUILD_HOOK_ENABLE_CUSTOM=true $(BIN)/python -m hatchling build -t wheel
	@ls -l dist/*.whl

install-check:
	tools/install_check.sh

# What checks the practice page's modules besides Node and Chromium; nobody else needs it.
page-tools:
	cd tests/page && npm install --no-audit --no-fund --no-package-lock --ignore-scripts

clean:
	rm -rf $(VENV) build dist .mypy_cache .ruff_cache .pytest_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
