"""coverage.py SCRIPTS TRANSCRIPTS: checks the coverage of the scripts.

The scripts must show every method, event, error kind and limit. SCRIPTS is their folder,
TRANSCRIPTS the folder of their recorded messages.
"""

import json
import sys
from pathlib import Path

import schemas

LEAST_SCRIPTS = 40
# Error kinds and events that a client cannot cause, the end of the server, and clusters. The events
# of the governor depend on the speed of the machine.
NOT_SHOWN = {
    "internal_error", "storage_failed", "not_recovered", "session.diverged", "session.storage",
    "server.draining", "server.drain", "server.move", "moved", "session.moved",
    "governor.switched",
}
# Limits that apply before a WebSocket is open or below its messages.
BELOW_MESSAGES = {"handshake_seconds", "ping_seconds"}
# Evidence for each limit of server.info. A path: invalid parameters there. A reason: a parse error.
# A number: the close code of a connection. A script: its only subject.
LIMITS = {
    "burst_seconds": ("script", "too-often"), "connections_per_address": ("script", "sharing"),
    "controls_per_second": "limit", "expire_after_seconds": ("script", "empty-sessions"),
    "hibernate_after_seconds": ("script", "empty-sessions"),
    "replay_expire_after_seconds": ("script", "empty-sessions"),
    "message_bytes_per_second": ("closed", 4009), "particles_in_all": "limit",
    "pointer_moves_per_second": "limit", "queries_per_second": "limit",
    "refusals_per_second": ("closed", 4009), "scenes_per_second": "limit",
    "reads_per_second": "limit", "read_bytes_per_second": "limit",
    "read_seconds_per_second": ("script", "reading"),
    "session_read_bytes_per_second": "limit",
    "session_read_seconds_per_second": ("script", "reading"),
    "sessions_per_address": "limit", "springs": "limit", "springs_in_all": "limit",
    "applied_forces": "limit", "bodies": ("path", "/scene/bodies"), "clients_per_session": "limit",
    "command_bytes_in_flight": ("script", "limits"), "commands_in_flight": "limit",
    "connections": ("closed", 1013), "control_queue_bytes": ("closed", 4008),
    "queue_bytes_in_all": ("script", "slow-client"), "memory_bytes": ("script", "limits"),
    "frame_groups": ("script", "frames"), "frame_patience_seconds": ("script", "slow-client"),
    "frame_window": ("script", "acknowledging"), "grabs_per_client": "limit",
    "grab_idle_seconds": ("script", "presence"), "grabs_per_session": "limit",
    "message_bytes": "limit", "message_depth": ("reason", "too_deep"),
    "message_values": ("reason", "too_many_values"), "name_bytes": ("path", "/name"),
    "download_bytes": ("script", "recordings"), "particle_steps_per_tick": "limit",
    "particles": "limit", "presence": ("script", "presence"),
    "connections_listed": ("path", "/most"),
    "recording_bytes": ("path", "/size"), "recording_ticks": ("script", "recordings"),
    "recording_entries": ("script", "recordings"), "imports": "limit",
    "import_bytes": ("script", "recordings"), "replays": ("script", "replays"),
    "resume_seconds": ("script", "coming-back"), "scene_message_bytes": ("closed", 1009),
    "states_per_session": "limit", "state_bytes_per_session": "limit",
    "state_bytes_in_all": "limit", "scenes_per_address": "limit",
    "scene_bytes_per_address": "limit", "scenes_in_all": "limit", "scene_bytes_in_all": "limit",
    "sessions": "limit", "ticks_per_step": ("path", "/ticks"), "tokens": "limit",
}


class Seen:
    """Contents of the scripts' transcripts."""

    def __init__(self, scripts, transcripts):
        self.results, self.events, self.kinds = set(), set(), set()
        self.shown = {("script", path.stem) for path in scripts}
        self.limits = set()
        for script in scripts:
            methods = {}
            with open(transcripts / f"{script.stem}.jsonl", encoding="utf-8") as file:
                for line in file:
                    self.entry(json.loads(line), methods)

    def entry(self, entry, methods):
        if "closed" in entry:
            self.shown.add(("closed", entry["closed"]))
            return
        try:
            message = json.loads(entry["sent" if "sent" in entry else "received"])
        except (ValueError, RecursionError):
            return
        if not isinstance(message, dict):
            return
        key = (entry["connection"], json.dumps(message.get("id")))
        if "sent" in entry:
            methods[key] = message.get("method")
        elif "method" in message:
            self.events.add(message["method"])
        elif "result" in message:
            self.results.add(methods.get(key))
            self.limits |= set(message["result"].get("limits", ()))
        else:
            self.error(message["error"]["data"])

    def error(self, data):
        self.kinds.add(data["kind"])
        self.shown |= {("limit", data.get("limit")), ("reason", data.get("reason"))}
        self.shown |= {("path", error["path"]) for error in data.get("errors", ())}

    def lacks(self):
        """Returns a description of everything that no script shows."""
        yield from (f"no result of {m}" for m in sorted(set(schemas.methods()) - NOT_SHOWN - self.results))
        events = set(schemas.definitions("events"))
        yield from (f"no event {name}" for name in sorted(events - NOT_SHOWN - self.events))
        yield from (f"no error {kind}" for kind in sorted(kinds() - NOT_SHOWN - self.kinds))
        yield from (f"no word here on the limit {name}" for name in sorted(self.limits - set(LIMITS) - BELOW_MESSAGES))
        yield from (f"no limit {name} in server.info" for name in sorted(set(LIMITS) - self.limits))
        for name, how in LIMITS.items():
            if (("limit", name) if how == "limit" else how) not in self.shown:
                yield f"the limit {name} is not shown by {how}"


def kinds():
    choices = schemas.definitions("errors")["reply_error"]["oneOf"]
    return {choice["$ref"].removeprefix("#/$defs/") for choice in choices}


def uncommented(path):
    """Returns whether the script lacks a comment at its start."""
    with open(path, encoding="utf-8") as file:
        first = [json.loads(line) for line in file if line.strip()][:2]
    return not any("comment" in line for line in first)


def main():
    scripts = sorted(Path(sys.argv[1]).glob("*.jsonl"))
    faults = list(Seen(scripts, Path(sys.argv[2])).lacks())
    faults += [f"{path.name} does not say what it shows" for path in scripts if uncommented(path)]
    if len(scripts) < LEAST_SCRIPTS:
        faults.append(f"{len(scripts)} scripts, fewer than {LEAST_SCRIPTS}")
    for fault in faults:
        print(fault)
    print(f"{len(scripts)} scripts, {len(schemas.methods())} methods, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
