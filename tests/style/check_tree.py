"""check_tree.py ROOT: holds the checkout at ROOT to every rule; exits 1 and lists the faults."""

import sys

import document_rules
import folder_order
import import_cycles
import source_rules
from tree import read_tree

RULES = source_rules.RULES + folder_order.RULES + import_cycles.RULES + document_rules.RULES


def main():
    tree = read_tree(sys.argv[1])
    if "CMakeLists.txt" not in tree.files:
        print(f"{sys.argv[1]} is no checkout")
        return 2
    faults = [(rule.__name__, fault) for rule in RULES for fault in rule(tree)]
    for name, fault in faults:
        print(f"{fault} ({name})")
    print(f"{len(tree.files)} files, {len(RULES)} rules, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
