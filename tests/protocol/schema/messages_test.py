"""Tests the check of messages: a transcript with each fault, and one without faults."""

import json
import tempfile
import unittest
from collections import Counter
from pathlib import Path

from messages import Transcript


def sent(message, **more):
    text = message if isinstance(message, str) else json.dumps({"jsonrpc": "2.0", **message})
    return {"connection": "a", "sent": text, **more}


def received(message):
    return {"connection": "a", "received": json.dumps({"jsonrpc": "2.0", **message})}


def error(identity, code, kind, **data):
    return received({"id": identity, "error": {
        "code": code, "message": "m", "data": {"kind": kind, "hint": "h", **data}}})


def refused(identity, code):
    errors = [{"code": code, "path": "/x", "message": "m"}]
    return error(identity, -32602, "invalid_params", path="/x", errors=errors)


class Messages(unittest.TestCase):
    def faults(self, *entries):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "t.jsonl"
            path.write_text("".join(json.dumps(entry) + "\n" for entry in entries), "utf-8")
            return Transcript(path, Counter()).read()

    def assert_fault(self, wanted, *entries):
        found = self.faults(*entries)
        self.assertEqual(len(found), 1, found)
        self.assertRegex(found[0], wanted)

    play = {"id": 1, "method": "control.play"}
    status = {"tick": 1, "time": 0, "playing": True, "speed": 1, "real_time_factor": 1,
              "clients": 1, "particles": 2}

    def test_right_messages_have_none(self):
        self.assertEqual(self.faults(
            sent(self.play), received({"id": 1, "result": {"tick": 3}}),
            received({"method": "session.status", "params": self.status}),
            sent({"id": 2, "method": "control.play", "params": {"x": 1}}),
            refused(2, "unknown_member"),
            sent("{"), error(None, -32700, "parse_error", reason="parse_error"),
            sent({"method": "no.such"}, wrong=True)), [])

    def test_results_are_checked(self):
        self.assert_fault("'tick' is a required", sent(self.play), received({"id": 1, "result": {}}))
        self.assert_fault("'tock' was unexpected", sent(self.play),
                          received({"id": 1, "result": {"tick": 3, "tock": 4}}))

    def test_events_are_checked(self):
        self.assert_fault("no schema for the event", received({"method": "n", "params": {}}))
        params = {**self.status, "tick": -1}
        self.assert_fault("minimum", received({"method": "session.status", "params": params}))

    def test_errors_are_checked(self):
        self.assert_fault("not valid", sent(self.play), error(1, 1001, "not_left"))
        self.assert_fault("not valid", sent(self.play), error(1, 1002, "not_joined"))

    def test_the_server_and_the_schemas_agree(self):
        wrong = {"id": 1, "method": "control.set_speed", "params": {"speed": 9}}
        self.assert_fault("accepted by the server", sent(wrong),
                          received({"id": 1, "result": {"tick": 3}}))
        self.assert_fault("refused for no_such_body only", sent(wrong),
                          error(1, 1003, "no_such_body", path="/body"))
        self.assert_fault("right for the schemas", sent(self.play), refused(1, "unknown_member"))

    def test_what_is_not_answered_must_be_right_or_marked(self):
        self.assert_fault("not marked as wrong", sent({"method": "no.such"}))
        self.assert_fault("not marked as wrong", sent("{"))
        self.assert_fault("not marked as wrong", sent({"id": 1, "method": "no.such"}))

    def test_replies_have_a_request(self):
        self.assert_fault("not asked", received({"id": 1, "result": {"tick": 3}}))


if __name__ == "__main__":
    unittest.main()
