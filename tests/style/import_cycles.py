"""The rule that files and folders of client and viewer import each other in one direction."""

import graphlib
import posixpath
import re

IMPORT = re.compile(r"^(?:import|export)\b[^;]*?\bfrom '(\.[^']+)'", re.MULTILINE)


def imports(tree):
    """Returns (importing file, imported file) of all relative imports."""
    for path, text in tree.matching(["web/"], (".ts",)):
        for target in IMPORT.findall(text):
            target = posixpath.normpath(posixpath.join(posixpath.dirname(path), target))
            yield path, re.sub(r"\.js$", "", target) + ".ts"


def cycles(edges, what):
    graph = {}
    for importing, imported in edges:
        graph.setdefault(importing, set()).add(imported)
    try:
        graphlib.TopologicalSorter(graph).prepare()
    except graphlib.CycleError as error:
        return [f"imports of {what} form a cycle: " + " <- ".join(error.args[1])]
    return []


def import_cycles(tree):
    edges = list(imports(tree))
    folders = {tuple(map(posixpath.dirname, edge)) for edge in edges}
    return cycles(edges, "files") or cycles((f for f in folders if f[0] != f[1]), "folders")


RULES = (import_cycles,)
