# Needs only Python 3.11 to 3.14, pip and make. Every target does its own set-up; the second run starts at once.
#   make demo         fly paper/figure-5 and say what came out
#   make test         the fast tests; make test-slow the others; make test-all both
#   make check        style, types, layers, docstrings, spelling
#   make bench        speed of the named workloads
#   make pictures     draw the pictures of the gallery and of the worked studies again
#   make screens      take the pictures of the report and the laboratory again; needs Chromium and pdftoppm
#   make docs         build the site of these pages, without a network, into .cache/site
#   make size         what an installation without the development tools weighs
#   make constraints  resolve the versions again (on the oldest Python)
#   make clean        remove what the targets made
# PYTHON=python3.13 chooses the interpreter, VENV=folder another environment, ARGS="-k word" goes to pytest.

VENV ?= .venv
PYTHON ?=
ARGS ?=
PYTHONS := python3.14 python3.13 python3.12 python3.11 python3
OLDEST := python3.11
BIN := $(VENV)/bin
SOURCES := src tests $(wildcard benchmarks examples)

export PIP_DISABLE_PIP_VERSION_CHECK = 1
export PIP_NO_INPUT = 1
# relative, so that a folder with spaces works; the second name is the one newer pips read for build isolation
export PIP_CONSTRAINT = constraints.txt
export PIP_BUILD_CONSTRAINT = constraints.txt

SAY := printf '==> %s\n'

# An environment is ready where its interpreter runs, and lies where it was made: a copied folder would run the original's
# sources. PYTHON, when given, must be the interpreter that it was made from.
IDENTITY := import sys; print(sys.version_info[:2])
MADE_IN := $(shell $(BIN)/python -c 'print(open("$(VENV)/made-in").read())' 2>/dev/null)
MADE_FROM := $(if $(PYTHON),$(shell $(BIN)/python -c '$(IDENTITY)' 2>/dev/null))
WANTED := $(if $(PYTHON),$(shell $(PYTHON) -c '$(IDENTITY)' 2>/dev/null))
ifneq ($(MADE_IN)/$(MADE_FROM),$(CURDIR)/$(WANTED))
REMAKE := remake
endif

.PHONY: demo test test-slow test-all check bench docs screens pictures size constraints clean setup setup-dev remake
.DEFAULT_GOAL := demo

demo: setup
	@$(BIN)/cardume run paper/figure-5

test: setup-dev
	@$(SAY) "fast tests (make test-all runs the slow ones too)"
	@$(BIN)/python -m pytest -m "not slow" -n auto $(ARGS)

test-slow: setup-dev
	@$(SAY) "slow tests"
	@$(BIN)/python -m pytest -m slow -n auto $(ARGS) || { [ $$? -eq 5 ] && $(SAY) "no test is marked slow"; }

test-all: setup-dev
	@$(SAY) "all tests, the slow ones included"
	@$(BIN)/python -m pytest -n auto $(ARGS)

# every step runs, so that one look shows all that is wrong
check: setup-dev
	@failed=""; \
	step() { name="$$1"; $(SAY) "$$2"; shift 2; "$$@" || failed="$$failed $$name"; }; \
	step style "style: ruff check, what is wrong or fragile" $(BIN)/ruff check $(SOURCES); \
	step format "format: ruff format, how it is laid out (mend with: $(BIN)/ruff format $(SOURCES))" $(BIN)/ruff format --check $(SOURCES); \
	step types "types: mypy strict on src" $(BIN)/mypy; \
	step layers "layers: import-linter, who may import whom" $(BIN)/lint-imports --cache-dir .cache/import-linter; \
	step docstrings "docstrings: units, shapes, errors and sources are stated" \
	    $(BIN)/python -m pytest -q -p no:xdist tests/contracts/test_docstrings.py; \
	step spelling "spelling: codespell" $(BIN)/codespell; \
	if [ -n "$$failed" ]; then $(SAY) "FAILED:$$failed"; exit 1; fi; \
	$(SAY) "all checks passed"

bench: setup-dev
	@$(BIN)/python -m benchmarks

docs: setup-dev
	@$(BIN)/python docs/site/build.py

screens: setup-dev
	@$(BIN)/python examples/screens.py

pictures: setup-dev
	@$(BIN)/python examples/gallery.py
	@$(BIN)/python examples/studies.py
	@$(BIN)/python examples/modem.py
	@$(BIN)/python examples/talking.py
	@$(BIN)/python examples/ranging.py

size: setup
	@$(BIN)/python .ci/size.py

setup: $(VENV)/core
setup-dev: $(VENV)/dev

$(VENV)/core: $(VENV)/made-in pyproject.toml constraints.txt
	@$(SAY) "installing cardume, what it needs to run, and what draws its report (downloads about 135 MB the first time)"
	@$(BIN)/python -m pip install --quiet --editable '.[report]'
	@touch $@

$(VENV)/dev: $(VENV)/core
	@$(SAY) "installing the tools for tests and checks"
	@$(BIN)/python -m pip install --quiet --editable '.[dev]'
	@touch $@

# Takes the first interpreter that really runs (a pyenv shim may not), is supported, and can make environments.
$(VENV)/made-in: $(REMAKE)
	@lacking=""; \
	for python in $(if $(PYTHON),$(PYTHON),$(PYTHONS)); do \
	    version=$$($$python -c 'import sys; v = sys.version_info[:2]; print("%d.%d" % v if (3, 11) <= v < (3, 15) else "")' 2>/dev/null) || continue; \
	    [ -n "$$version" ] || continue; \
	    if ! $$python -c 'import venv, ensurepip' 2>/dev/null; then \
	        case " $$lacking " in *" $$version "*) ;; *) lacking="$$lacking $$version" ;; esac; continue; \
	    fi; \
	    $(SAY) "making $(VENV) with Python $$version"; \
	    $$python -m venv --clear $(VENV) && printf '%s' "$(CURDIR)" > $@ && exit 0; \
	    $(SAY) "$$python -m venv failed"; exit 1; \
	done; \
	for version in $$lacking; do \
	    $(SAY) "Python $$version is here, but without its venv module. On Debian and Ubuntu: sudo apt install python$$version-venv"; \
	done; \
	[ -n "$$lacking" ] || $(SAY) "no Python 3.11 to 3.14 found$(if $(PYTHON), at PYTHON=$(PYTHON)). Install one, or name it: make PYTHON=/path/to/python3.12"; \
	exit 1

constraints:
	@$(SAY) "resolving all versions on $(OLDEST)"
	@rm -rf .cache/resolve && $(OLDEST) -m venv .cache/resolve
	@PIP_CONSTRAINT= PIP_BUILD_CONSTRAINT= .cache/resolve/bin/python -m pip install --quiet '.[dev,rerun]' hatchling editables
	@{ echo "# Versions that are known to work together, resolved on $(OLDEST) by: make constraints"; \
	   .cache/resolve/bin/python -m pip freeze --exclude cardume; } > constraints.txt
	@rm -rf .cache/resolve

clean:
	rm -rf $(VENV) .cache build dist
	find src tests -name __pycache__ -prune -exec rm -rf {} +
