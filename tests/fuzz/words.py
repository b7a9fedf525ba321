"""words.py TARGET: prints a dictionary for the fuzzer, with all names of the target's format.

The names are the quoted words of the files that define the format. TARGET.dict has other parts.
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SOURCES = {
    "convert": "protocol/convert/*.cpp",
    "messages": "protocol/schemas/*.json",
    "scene": "protocol/schemas/scene_format.json",
    "settings": "server/settings/serve_settings.cpp",
}
VALUES = ("null", "true", "[0,0,0]", "-0", "-1", "0.001", "1e-320", "1e308", "1e999",
          "18446744073709551616")


def main():
    target = sys.argv[1]
    own = Path(__file__).with_name(f"{target}.dict")
    print(own.read_text("utf-8") if own.exists() else "")
    if target not in SOURCES:
        return
    text = "".join(path.read_text("utf-8") for path in ROOT.glob(SOURCES[target]))
    names = {name.removesuffix(".params") for name in re.findall(r'"([A-Za-z][\w./]*)"', text)}
    print(*(f'"\\"{name}\\""' for name in sorted(names)), *(f'"{value}"' for value in VALUES), sep="\n")


if __name__ == "__main__":
    main()
