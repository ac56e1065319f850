"""Class names are unique, so readers need not look up where a class was imported from."""

import ast
from collections import defaultdict

from project_files import ROOT, project_files


def test_no_two_classes_share_a_name():
    places = defaultdict(list)
    for path in project_files(".py"):
        if path.is_relative_to(ROOT / "src"):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.ClassDef):
                    places[node.name].append(str(path.relative_to(ROOT)))
    assert len(places) > 100
    assert not {name: paths for name, paths in places.items() if len(paths) > 1}
