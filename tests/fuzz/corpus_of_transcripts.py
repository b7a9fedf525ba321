"""corpus_of_transcripts.py TRANSCRIPTS FOLDER: converts transcripts to inputs, for `./vat check fuzz`.

The clients' messages of each transcript become an input of the target `messages`. Long transcripts
are truncated. Messages that do not fit on a line are omitted.
"""

import json
import sys
from pathlib import Path

MOST_BYTES = 6000
CLIENTS = "1", "2", "3"


def input_of(path):
    """Returns the lines, prefixed by the connection's client, with tokens replaced by their name."""
    lines, clients, tokens = [], {}, set()
    with open(path, encoding="utf-8") as file:
        for entry in map(json.loads, file):
            if "received" in entry:
                tokens |= tokens_in(entry["received"])
            if "sent" not in entry:
                continue
            client = clients.setdefault(entry["connection"], CLIENTS[len(clients) % len(CLIENTS)])
            text = entry["sent"]
            for token in tokens:
                text = text.replace(token, "@token")
            if "\n" not in text and len(text) < MOST_BYTES:
                lines.append(("" if client == "1" else client) + text)
    size = 0
    for number, line in enumerate(lines):
        size += len(line.encode()) + 1
        if size > MOST_BYTES:
            return lines[:number]
    return lines


def tokens_in(text):
    try:
        result = json.loads(text).get("result", {})
    except ValueError:
        return set()
    return {result[key] for key in ("token", "resume") if key in result}


def main():
    transcripts, folder = map(Path, sys.argv[1:])
    for path in sorted(transcripts.glob("*.jsonl")):
        lines = input_of(path)
        if lines:
            (folder / f"script-{path.stem}").write_text("\n".join(lines) + "\n", "utf-8")


if __name__ == "__main__":
    main()
