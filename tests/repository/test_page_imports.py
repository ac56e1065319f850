"""The imports between modules of the page have no cycle."""

import re
from graphlib import TopologicalSorter

from project_files import ROOT

SOURCE = ROOT / "web" / "src"
IMPORT = re.compile(r"""^(?:import|export) [^;]*?from "(\.[^"]+)";""", re.MULTILINE)


def test_no_module_of_the_page_imports_itself_by_way_of_others():
    graph = {}
    for path in SOURCE.rglob("*.ts"):
        names = IMPORT.findall(path.read_text(encoding="utf-8"))
        graph[path] = {(path.parent / f"{name.partition('?')[0]}.ts").resolve() for name in names}
    assert sum(map(len, graph.values())) > 100
    order = list(TopologicalSorter(graph).static_order())  # raises a CycleError, which names the modules
    assert order.index(SOURCE / "element.ts") < order.index(SOURCE / "app.ts")
