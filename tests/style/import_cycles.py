"""Files of the client and the viewer import each other in one direction."""

import graphlib
import posixpath
import re

IMPORT = re.compile(r"^(?:import|export)\b[^;]*?\bfrom '(\.[^']+)'", re.MULTILINE)


def import_cycles(tree):
    graph = {}
    for path, text in tree.matching(["web/"], (".ts",)):
        targets = (posixpath.normpath(posixpath.join(posixpath.dirname(path), target))
                   for target in IMPORT.findall(text))
        graph[path] = {re.sub(r"\.js$", "", target) + ".ts" for target in targets}
    try:
        graphlib.TopologicalSorter(graph).prepare()
    except graphlib.CycleError as error:
        return ["imports form a cycle: " + " <- ".join(error.args[1])]
    return []


RULES = (import_cycles,)
