# The project's tasks. Each sets up what it needs, in ignored folders of this checkout (.tools/, .venv*/), and does
# nothing to the rest of the machine. The README lists the `uv` commands behind them, for those without make.

SCENE =
FRAMES =
SIZE =

# The uv on PATH, if it runs and is new enough; else one of our own, which keeps its Pythons and downloads to itself.
UV := $(shell uv run --no-default-groups --help >/dev/null 2>&1 && echo uv || echo .tools/bin/uv)
OWN_UV := $(filter-out uv,$(UV))
ifneq ($(OWN_UV),)
export UV_PYTHON_INSTALL_DIR = $(CURDIR)/.tools/python
export UV_CACHE_DIR = $(CURDIR)/.tools/cache
endif
PYTHON := $(UV) run python
READY := .venv/blender-runs

.PHONY: help setup demo test test-all lint bench bench-pairs figures package clean
.DEFAULT_GOAL := help

help: ## list the tasks
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-11s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

setup: $(READY) ## get Python 3.13, Blender 5.2 as a module, and numba

demo: $(READY) ## morph, plan and render a scene; SCENE=... FRAMES=... SIZE=... choose otherwise
	@$(PYTHON) -m demo_scenes.render \
	    $(if $(SCENE),--scene "$(SCENE)") $(if $(FRAMES),--frames $(FRAMES)) $(if $(SIZE),--size $(SIZE))

figures: $(READY) ## draw the paper's figures, its table of timings, and what matching adds
	@$(PYTHON) -m demo_scenes.figures

test: $(READY) ## run the tests, under Blender 5.2
	@$(PYTHON) -m pytest

test-all: test test-4.5 test-4.2 ## run the tests under Blender 5.2, 4.5 and 4.2

test-4.5 test-4.2: test-%: $(OWN_UV)
	@echo "Blender $*"
	@UV_PROJECT_ENVIRONMENT=.venv-$* $(UV) run --python 3.11 \
	    --no-default-groups --group dev --group blender-$(subst .,-,$*) python -m pytest

lint: $(OWN_UV) ## check the code's style
	@$(PYTHON) -m ruff check
	@$(PYTHON) -m ruff format --check

bench: $(READY) ## measure speed and memory, as a table and into out/benchmarks.json
	@$(PYTHON) -m pytest tests/benchmarks/bench_*.py

bench-pairs: $(READY) ## match every shape to every other, into out/pairs.md
	@$(PYTHON) tests/benchmarks/pairs.py

package: $(READY) ## build the extension's zips, one for each platform
	@$(PYTHON) -m release

clean: ## remove everything that was made, but keep what was set up
	@rm -rf out .pytest_cache .ruff_cache .hypothesis .benchmarks
	@find . \( -name '.venv*' -o -name .tools -o -name .git \) -prune -o -name __pycache__ -prune -exec rm -rf {} +

# ---- set-up ----------------------------------------------------------------------------------------------------------

$(READY): pyproject.toml $(OWN_UV)
	@$(UV) sync
	@$(PYTHON) -c "import bpy" || { echo "Blender lacks a library of the system. On Debian or Ubuntu: apt install" \
	    "libx11-6 libxrender1 libxfixes3 libxi6 libxkbcommon0 libxxf86vm1 libsm6 libgl1 libgomp1"; exit 1; }
	@touch $@

UV_VERSION := 0.13.9
# uv is a program: its wheel runs beside any Python, also beside one that it would not manage.
INSTALL := -m pip install --quiet --disable-pip-version-check
INSTALL_UV := $(INSTALL) --target "$(CURDIR)/.tools" --only-binary :all: --ignore-requires-python uv==$(UV_VERSION)

# By pip; else by a newer pip in a virtual environment; else by pip's source: some Pythons come without, but git is here.
# From another folder, since pyenv refuses to run python3 beside a .python-version that it cannot serve.
.tools/bin/uv:
	@echo "setting up uv in .tools/"
	@mkdir -p .tools
	@cd / && tools="$(CURDIR)/.tools" && exec 2> "$$tools/setup.log" && { \
	    python3 $(INSTALL_UV) \
	    || { python3 -m venv "$$tools/venv" >&2 && "$$tools/venv/bin/python" $(INSTALL) --upgrade pip \
	         && "$$tools/venv/bin/python" $(INSTALL_UV); } \
	    || { git clone --quiet --depth 1 --branch 26.3 https://github.com/pypa/pip.git "$$tools/pip" \
	         && PYTHONPATH="$$tools/pip/src" python3 $(INSTALL_UV); } \
	    || { cat "$$tools/setup.log"; \
	         echo "Could not set up uv: install it (https://docs.astral.sh/uv/), or python3 with pip, and try again."; \
	         exit 1; }; }
