# Two commands from a fresh clone: `make run` and `make test`. Both install what they need into this folder.
PYTHON ?= python3
UV := $(shell command -v uv 2>/dev/null || echo .uv/bin/uv)
RUN := $(UV) run --no-progress

.PHONY: run test sync stubs clean

# The main job: a short life of the baseline world, about two minutes on two cores.
run: sync
	$(RUN) hedon run baseline

test: sync
	$(RUN) ruff check .
	$(RUN) ruff format --check .
	$(RUN) clang-format --dry-run -Werror $(shell find engine -name '*.h' -o -name '*.cpp')
	$(RUN) lint-imports
	$(RUN) pyright
	$(RUN) pytest
	$(RUN) python tests/sanitize.py asan

sync: $(UV) compiler
	$(UV) sync --quiet

.PHONY: compiler
compiler:
	@command -v "$${CXX:-c++}" >/dev/null 2>&1 || command -v g++ >/dev/null 2>&1 || command -v clang++ >/dev/null 2>&1 || { \
	  echo "hedon needs a C++20 compiler (g++ 12 or clang 15, or newer) to build its engine, and found none." >&2; \
	  echo "Debian and Ubuntu: apt-get install g++    Fedora: dnf install gcc-c++    macOS: xcode-select --install" >&2; \
	  exit 2; }

.uv/bin/uv:
	@echo "uv is not installed: putting it into .uv"
	$(PYTHON) -m pip install --quiet --disable-pip-version-check --no-warn-script-location --target .uv uv

# The engine's type stubs, after a change of its bindings.
stubs: sync
	rm -rf src/hedon/_engine
	$(RUN) python -m nanobind.stubgen -q -r -m hedon._engine -O src/hedon

clean:
	rm -rf build .venv .uv .pytest_cache .ruff_cache
