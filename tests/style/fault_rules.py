"""The rule of the known faults in tests/faults."""

import json


def known_faults(tree):
    """Each fault replaces a text that occurs once in its source, and has a test that detects it."""
    faults = []
    for path, text in tree.matching(["tests/faults/"], [".json"]):
        for fault in json.loads(text):
            name = f"{path}: {fault['name']}"
            count = tree.files.get(fault["file"], "").count(fault["before"])
            if count != 1:
                faults.append(f"{name}: its text occurs {count} times in {fault['file']}")
            if not fault.get("detected_by"):
                faults.append(f"{name}: no test detects it")
    return faults


RULES = (known_faults,)
