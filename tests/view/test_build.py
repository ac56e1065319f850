"""The built page and modules in the package match their sources."""

import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from project_files import ROOT

from hedon.view.page import STATIC, page_files

pytestmark = pytest.mark.smoke

WEB = ROOT / "web"
MODULES = ("hedon.wasm", "hedon-relaxed.wasm")


def test_the_page_is_small():
    """Compressed and without records; servers and code hosts compress in the same way."""
    import gzip

    sizes = {
        name: len(gzip.compress(path.read_bytes()))
        for name, path in page_files().items()
        if not name.startswith(("hero.", "still/"))  # loaded after the first picture, or only if a world cannot run
    }
    both = sum(size for name, size in sizes.items() if name.endswith(".wasm"))
    assert sum(sizes.values()) - both / 2 < 350_000  # what a visitor to the page and the article loads: one module
    assert sum(sizes.values()) < 550_000
    assert sum(path.stat().st_size for name, path in page_files().items() if name.startswith("hero.")) < 400_000


@pytest.mark.skipif(
    shutil.which("npx") is None or not (WEB / "node_modules").is_dir(),
    reason="needs Node and the page's packages: npm install --prefix web",
)
def test_the_built_page_matches_its_sources(tmp_path):
    command = ["npm", "run", "--silent", "build", "--", "--outDir", str(tmp_path)]
    subprocess.run(command, cwd=WEB, check=True, capture_output=True)
    built = {path.relative_to(tmp_path).as_posix(): path for path in tmp_path.rglob("*") if path.is_file()}
    assert set(built) == set(page_files()) - set(MODULES)
    for name, path in built.items():
        assert path.read_bytes() == (STATIC / name).read_bytes(), f"{name}: run `make viewer`"


@pytest.mark.long
@pytest.mark.skipif(find_spec("ziglang") is None, reason="needs the compiler: uv sync --group viewer")
@pytest.mark.parametrize("module", MODULES)
def test_a_built_module_matches_its_sources(module, tmp_path):
    program = "import sys; sys.path.insert(0, 'web'); import build; from pathlib import Path; "
    program += f"build.build_module({module!r}, Path({str(tmp_path)!r}))"
    subprocess.run([sys.executable, "-c", program], cwd=ROOT, check=True)
    assert (Path(tmp_path) / module).read_bytes() == (STATIC / module).read_bytes(), "run `make viewer`"
