"""The rule of the known faults in tests/faults."""

import json
import re

CTEST = re.compile(r"[a-z]+/(?:\w+/)?(?P<suite>\w+)\.(?P<name>\w+)(?:/\w+)?")
WEB_TEST = re.compile(r"[a-z]+/[a-z]+: (?P<file>\S+) > .+")
DEFINITION = re.compile(r"\bTEST(?:_[FP])?\(\s*(\w+),\s*(\w+)\)")


def is_known(test, definitions, tree):
    """Returns whether the test, or for the viewer the file of the test, exists."""
    ctest = CTEST.fullmatch(test)
    if ctest:
        return (ctest["suite"], ctest["name"]) in definitions
    web_test = WEB_TEST.fullmatch(test)
    return web_test is not None and tree.has(web_test["file"])


def known_faults(tree):
    """Each fault replaces a text that occurs once in its source. Tests that exist detect it."""
    definitions = {definition for _, text in tree.matching(["tests/"], [".cpp"])
                   for definition in DEFINITION.findall(text)}
    faults = []
    for path, text in tree.matching(["tests/faults/"], [".json"]):
        for fault in json.loads(text):
            name = f"{path}: {fault['name']}"
            count = tree.files.get(fault["file"], "").count(fault["before"])
            if count != 1:
                faults.append(f"{name}: its text occurs {count} times in {fault['file']}")
            tests = fault.get("detected_by")
            if not tests:
                faults.append(f"{name}: no test detects it")
            faults += [f"{name}: there is no test {test}" for test in tests or []
                       if not is_known(test, definitions, tree)]
    return faults


RULES = (known_faults,)
