"""shown_scene.py DOCUMENT PROGRAM: checks that the only scene in a document is valid and runs."""

import re
import subprocess
import sys
import tempfile


def main():
    document, program = sys.argv[1:]
    with open(document, encoding="utf-8") as file:
        blocks = re.findall(r"```json\n(.*?)```", file.read(), re.DOTALL)
    scenes = [block for block in blocks if '"vat.scene/1"' in block]
    if len(scenes) != 1:
        print(f"{len(scenes)} scenes in {document}, not 1")
        return 1
    with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
        file.write(scenes[0])
        file.flush()
        subprocess.run([program, "validate", file.name], check=True)
        subprocess.run([program, "simulate", file.name, "--until", "0.5", "--hash"], check=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
