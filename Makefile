# Two commands from a fresh clone: `make run` and `make test`. Both install what they need into this folder.
PYTHON ?= python3
UV := $(shell command -v uv 2>/dev/null || echo .uv/bin/uv)
RUN := $(UV) run --no-progress --group dev
# The tests of the viewer's page need a browser; without one they are skipped, and say what to install.
BROWSER := $(if $(wildcard /usr/bin/chromium),--group browser)
# Rules in Python are compiled by Numba, some 190 MB, and videos by ffmpeg, 30 MB: only the tests install them. Long tests
# make clusters of Ray, 200 MB (80 MB to download), S3 servers, and wheels.
EXTRA := --extra rules --extra video
LONG := $(EXTRA) --extra ray --extra remote --group store --group tracker --group viewer --group cuda --group wheel
# One more than the processors that this may use: tests wait for browsers and for processes a fifth of the time.
WORKERS = $(shell $(PYTHON) -c 'import os; print(len(getattr(os, "sched_getaffinity", lambda _: range(os.cpu_count()))(0)) + 1)')
# What the site is made with.
SITE := --group docs
# Builds below start their own jobs: make's job server does not reach them through uv.
unexport MAKEFLAGS
# Where this is set, as in many containers, each process compiles all its Python modules again: seconds each time.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: run test test-more test-long everything suite suite-more static compiled sync cuda stubs viewer demo docs wheels clean

# The main job: a world in which a reward evolves within a minute on two cores.
run: sync
	$(UV) run --no-progress hedon run appetite --steps 40960 --frames 64

# What a change can break, in a few minutes. Both side by side: each leaves a processor idle at times.
test: everything
	$(MAKE) --no-print-directory --jobs=2 --output-sync=line static suite

# Slower tests: pages in a browser, emulated devices, processes that are killed, sites, nvcc, a sanitizer.
test-more: everything
	$(MAKE) --no-print-directory --jobs=2 --output-sync=line suite-more compiled

# Not `sync` first, which would remove what these tests need and install it again.
everything: tools $(UV)
	$(UV) sync --quiet --group dev $(BROWSER) $(SITE) $(EXTRA) --group cuda

SUITE = $(RUN) $(BROWSER) $(SITE) $(EXTRA) pytest --numprocesses $(WORKERS) --dist loadfile --no-loadscope-reorder

suite: tools $(UV)
	$(SUITE) -m "not long and not more"

# Two workers more, since these tests wait for browsers and processes.
suite-more: tools $(UV)
	$(SUITE) --numprocesses $$(($(WORKERS) + 2)) -m "more and not long"

static: tools $(UV)
	$(RUN) ruff check .
	$(RUN) ruff format --check .
	$(RUN) clang-format --dry-run -Werror $(shell find engine tests/native -name '*.h' -o -name '*.cpp' -o -name '*.cu')
	$(RUN) lint-imports
	$(RUN) pyright src benchmarks calibrations release

compiled: tools $(UV)
	$(RUN) --group cuda python tests/cuda.py
	$(RUN) python tests/sanitize.py asan

# The same questions asked hundreds of times, and those that take minutes: before a release, in addition to `make test` and `make test-more`.
test-long: sync
	$(RUN) $(BROWSER) $(SITE) $(LONG) pyright
	HEDON_NODES=10 HEDON_FUZZ=3000 HEDON_DOOR=20000 HEDON_KILLS=200 HEDON_REPORTS=20 HEDON_DAMAGED=20 \
	  HEDON_WORLDS=2000 HEDON_RECORDED=300 HEDON_SPOILED=300 HEDON_INTAKE=200 \
	  $(RUN) $(BROWSER) $(SITE) $(LONG) pytest --numprocesses auto --dist worksteal -m "long or repeated"
	$(RUN) --group viewer python tests/matrix.py
	$(RUN) python tests/soak.py
	$(RUN) python tests/cuda_step.py
	$(RUN) --group cuda python tests/cuda.py --variants
	$(RUN) python tests/sanitize.py asan --cuda
	$(RUN) python tests/sanitize.py tsan --cuda
	$(RUN) python tests/sanitize.py tsan

# Removes nothing: what tests need stays.
sync: tools $(UV)
	@test -d "$${UV_PROJECT_ENVIRONMENT:-.venv}" || \
	  echo "installing hedon into this folder and building its engine: one to two minutes on two free cores"
	$(UV) sync --quiet --inexact

# What has to be there already, each with the advice that helps where it is not.
.PHONY: tools
tools:
	@command -v "$${CXX:-c++}" >/dev/null 2>&1 || command -v g++ >/dev/null 2>&1 || command -v clang++ >/dev/null 2>&1 || { \
	  echo "hedon needs a C++20 compiler (g++ 12, clang 15, or newer) to build its engine, and found none." >&2; \
	  echo "Debian and Ubuntu: apt-get install g++    Fedora: dnf install gcc-c++" >&2; exit 2; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || { \
	  echo "hedon needs Python 3.11 or newer; '$(PYTHON)' is none. Name another: make $(MAKECMDGOALS) PYTHON=python3.12" >&2; exit 2; }
	@$(PYTHON) -c 'import os, sys, sysconfig; sys.exit(not os.path.exists(sysconfig.get_path("include") + "/Python.h"))' || { \
	  echo "hedon needs Python's headers to build its engine." >&2; \
	  echo "Debian and Ubuntu: apt-get install python3-dev    Fedora: dnf install python3-devel" >&2; exit 2; }

.uv/bin/uv:
	@$(PYTHON) -m pip --version >/dev/null 2>&1 || { \
	  echo "hedon installs uv by pip, and '$(PYTHON) -m pip' does not work." >&2; \
	  echo "Debian and Ubuntu: apt-get install python3-pip    Fedora: dnf install python3-pip    Or install uv yourself." >&2; exit 2; }
	@echo "uv is not installed: putting it into .uv (for uv commands of your own: export PATH=\"\$$PWD/.uv/bin:\$$PATH\")"
	@$(PYTHON) -m pip install --quiet --disable-pip-version-check --root-user-action=ignore --target .uv uv

# The library of CUDA devices, for `--backend cuda`. The compiler is a package, 350 MB; no device is needed to build.
cuda: sync
	$(RUN) --group cuda python engine/cuda/build.py

# The engine's type stubs, after a change of its bindings.
stubs: sync
	rm -rf src/hedon/_engine
	$(RUN) python -m nanobind.stubgen -q -r -m hedon._engine -O src/hedon

# The page and the WebAssembly of `hedon view`, after a change in web/ or engine/. Needs Node 20 or newer with npm.
viewer: sync
	$(RUN) --group viewer python web/build.py

# A demo of the live page with a run of `appetite`, in build/demo; the site of the documentation includes it.
demo: sync
	rm -rf build/demo build/demo-run
	$(RUN) hedon run appetite --steps 20480 --frames 64 --out build/demo-run
	$(RUN) hedon view build/demo-run --story --export build/demo

# The site of the documentation, in build/docs: python3 -m http.server --directory build/docs
docs: demo
	$(RUN) $(SITE) sphinx-build --quiet --fail-on-warning --conf-dir docs/site . build/docs
	$(RUN) $(SITE) python docs/site/paper.py build/docs/docs/paper/paper.pdf

# The source and the wheels of Linux, Windows and macOS, in dist, for every Python of 3.11 to 3.13 that is installed.
wheels: sync
	$(RUN) --group viewer --group wheel python -m release.wheel

clean:
	rm -rf build web/node_modules .venv .uv .pytest_cache .ruff_cache
