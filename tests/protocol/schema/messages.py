"""messages.py FOLDER: checks every message of the transcripts in FOLDER against the schemas.

The schemas must accept a client's message if the server accepts its form, and reject it if the
server does, as far as a schema can decide. If the server does not reply to an invalid message, the
transcript must mark it.
"""

import json
import sys
from collections import Counter, defaultdict
from pathlib import Path

import schemas

FORM_ERRORS = {-32700, -32600, -32601, -32602}
# Errors that a schema must find too, since they need no state.
PLAIN_FAULTS = {"missing", "unknown_member", "wrong_type"}
# Errors that the server finds before it reads the parameters, or the bodies and scenes in them.
BEFORE_PARAMETERS = {
    "limit_reached", "internal_error", "not_joined", "not_authenticated", "not_allowed",
    "rate_limited",
}


MAX_DEPTH = 16
MAX_VALUES = 100_000


def unique(pairs):
    members = dict(pairs)
    if len(members) < len(pairs):
        raise ValueError("a duplicate key")
    return members


def finite(text):
    number = float(text)
    if number in (float("inf"), float("-inf")) or number != number:
        raise ValueError("no double holds this number")
    return number


def whole(text):
    finite(text)
    return int(text)


def size(value):
    """Returns (depth, number of values)."""
    if isinstance(value, dict):
        value = list(value.values())
    if not isinstance(value, list):
        return 0, 1
    depths, counts = zip(*map(size, value)) if value else ((0,), ())
    return 1 + max(depths), 1 + sum(counts)


def is_too_much(message):
    depth, count = size(message)
    return depth > MAX_DEPTH or count > MAX_VALUES


def parse(text):
    """Returns the message, or None if the protocol does not accept it as JSON."""
    try:
        message = json.loads(
            text, object_pairs_hook=unique, parse_float=finite, parse_int=whole,
            parse_constant=finite)
        return None if is_too_much(message) else message
    except (ValueError, RecursionError):
        return None


def request_fault(message):
    """Returns the reason why a client's message is invalid, or None."""
    if message is None:
        return "not JSON"
    reason = schemas.fault(message, "message", "request")
    if reason:
        return reason
    method = message["method"]
    if method not in schemas.methods():
        return f"no schema for the method {method}"
    file = schemas.methods()[method]
    return schemas.fault(message.get("params", {}), file, method + ".params")


class Transcript:
    """Processes one transcript and collects faults."""

    def __init__(self, path, seen):
        self.path = path
        self.seen = seen
        self.faults = []
        self.asked = defaultdict(list)  # {(connection, id): [(method, fault, line)]}
        self.marked = set()  # lines of intentionally invalid messages
        self.unanswerable = defaultdict(list)  # {connection: lines with invalid messages}
        self.null_errors = Counter()  # {connection: error replies with the id null}

    def fail(self, line, text):
        self.faults.append(f"{self.path.name}:{line}: {text}")

    def read(self):
        with open(self.path, encoding="utf-8") as file:
            for number, text in enumerate(file, start=1):
                if not text.endswith("\n"):
                    break  # the test was killed while it wrote this line
                entry = json.loads(text)
                if "sent" in entry:
                    self.sent(entry, number)
                elif "received" in entry:
                    self.received(entry, number)
        for connection, wrong in self.unanswerable.items():
            for line, reason in wrong[self.null_errors[connection]:]:
                self.fail(line, f"sent, not answered and not marked as wrong: {reason}")
        for waiting in self.asked.values():
            for _, reason, line in waiting:
                if reason and line not in self.marked:
                    self.fail(line, f"sent, not answered and not marked as wrong: {reason}")
        return self.faults

    def sent(self, entry, line):
        self.seen["sent"] += 1
        message = parse(entry["sent"])
        reason = request_fault(message)
        self.seen["wrong"] += reason is not None
        identity = message.get("id") if isinstance(message, dict) else None
        if schemas.fault(identity, "message", "id") is None:
            key = (entry["connection"], json.dumps(identity))
            self.asked[key].append((message.get("method"), reason, line))
            self.marked |= {line} if entry.get("wrong") else set()
        elif reason and not entry.get("wrong"):
            self.unanswerable[entry["connection"]].append((line, reason))

    def received(self, entry, line):
        self.seen["received"] += 1
        message = parse(entry["received"])
        if isinstance(message, dict) and "method" in message:
            self.event(message, line)
            return
        reason = schemas.fault(message, "message", "reply", closed=True)
        if reason:
            self.fail(line, f"{reason}: {entry['received'][:300]}")
            return
        asked = self.asked[(entry["connection"], json.dumps(message["id"]))]
        if "error" in message:
            self.seen["error " + message["error"]["data"]["kind"]] += 1
        if message["id"] is None:
            self.null_errors[entry["connection"]] += 1
        elif not asked:
            self.fail(line, f"a reply to what was not asked: {entry['received'][:300]}")
        else:
            self.reply(message, *asked.pop(0), line)

    def event(self, message, line):
        name = message["method"]
        self.seen["event " + str(name)] += 1
        reason = schemas.fault(message, "message", "event", closed=True)
        if not reason and name not in schemas.definitions("events"):
            reason = f"no schema for the event {name}"
        reason = reason or schemas.fault(message["params"], "events", name, closed=True)
        if reason:
            self.fail(line, reason)

    def reply(self, message, method, wrong, asked_at, line):
        if "result" in message:
            self.seen["result " + str(method)] += 1
            if wrong:
                self.fail(asked_at, f"accepted by the server, not by the schemas: {wrong}")
                return
            file = schemas.methods()[method]
            reason = schemas.fault(message["result"], file, method + ".result", closed=True)
            if reason:
                self.fail(line, reason)
            return
        error = message["error"]
        kind = error["data"]["kind"]
        codes = {found["code"] for found in error["data"].get("errors", [])}
        if wrong and error["code"] not in FORM_ERRORS and kind not in BEFORE_PARAMETERS:
            self.fail(asked_at, f"refused for {kind} only, though wrong: {wrong}")
        if not wrong and (kind in {"invalid_request", "method_not_found"} or codes & PLAIN_FAULTS):
            self.fail(asked_at, f"right for the schemas, but the server says: {error['message']}")


def main():
    folder = Path(sys.argv[1])
    seen = Counter()
    faults = []
    paths = sorted(folder.glob("**/*.jsonl"))
    for path in paths:
        faults += Transcript(path, seen).read()
    for fault in faults[:100]:
        print(fault)
    print(f"{len(paths)} transcripts, {seen['sent']} messages sent, {seen['wrong']} of them wrong on "
          f"purpose, {seen['received']} received; {len(faults)} faults")
    if not seen["received"]:
        print(f"{folder} has nothing that a server said: the tests that write transcripts come "
              "first, with VAT_TRANSCRIPT as their folder; ctest sees to that")
    return 1 if faults or not seen["received"] else 0


if __name__ == "__main__":
    sys.exit(main())
