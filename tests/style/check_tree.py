"""check_tree.py ROOT: checks the checkout at ROOT by all rules.

Lists the faults, and exits with 1 if there are any.
"""

import sys

import document_rules
import fault_rules
import folder_order
import import_cycles
import source_rules
from tree import read_tree

MODULES = (source_rules, folder_order, import_cycles, document_rules, fault_rules)
RULES = tuple(rule for module in MODULES for rule in module.RULES)


def main():
    tree = read_tree(sys.argv[1])
    if "CMakeLists.txt" not in tree.files:
        print(f"{sys.argv[1]} is not a checkout")
        return 2
    faults = [(rule.__name__, fault) for rule in RULES for fault in rule(tree)]
    for name, fault in faults:
        print(f"{fault} ({name})")
    print(f"{len(tree.files)} files, {len(RULES)} rules, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
