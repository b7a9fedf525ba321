"""Writes protocol/asyncapi.json from the schemas: messages of client and server, and replies."""

import json

import schemas

DOCUMENT = schemas.ROOT / "protocol" / "asyncapi.json"
SCHEMA_FORMAT = "application/schema+json;version=draft-2020-12"
JSON_RPC = {"const": "2.0"}
CHANNEL = {"$ref": "#/channels/session"}


def shared(reference):
    return {"$ref": f"schemas/{reference}"}


def envelope(required, **properties):
    return {
        "type": "object", "required": ["jsonrpc", *required],
        "properties": {"jsonrpc": JSON_RPC, **properties},
    }


def message(name, summary, schema):
    payload = {"schemaFormat": SCHEMA_FORMAT, "schema": schema}
    return {"name": name, "summary": summary, "payload": payload}


def request_message(method, file):
    params = schemas.definitions(file)[method + ".params"]
    required = ["method"] + (["params"] if params.get("required") else [])
    schema = envelope(required, id=shared("message.json#/$defs/id"), method={"const": method},
                      params=shared(f"{file}.json#/$defs/{method}.params"))
    return message(method, params["description"], schema)


def reply_message(method, file):
    schema = envelope(["id"], id=shared("message.json#/$defs/id"),
                      result=shared(f"{file}.json#/$defs/{method}.result"),
                      error=shared("errors.json#/$defs/reply_error"))
    schema["oneOf"] = [{"required": ["result"]}, {"required": ["error"]}]
    return message(method + ".reply", f"Reply to {method}", schema)


def event_message(event):
    definition = schemas.definitions("events")[event]
    schema = envelope(["method", "params"], method={"const": event},
                      params=shared(f"events.json#/$defs/{event}"))
    return message(event, definition.get("description", "An event"), schema)


def frame_message():
    return {
        "name": "frame", "summary": "A frame: PROTOCOL.md, Frames",
        "contentType": "application/octet-stream",
        "payload": {"schemaFormat": SCHEMA_FORMAT, "schema": {"type": "string"}},
    }


def messages():
    found = {}
    for method, file in schemas.methods().items():
        found[method] = request_message(method, file)
        found[method + ".reply"] = reply_message(method, file)
    for event in schemas.definitions("events"):
        found[event] = event_message(event)
    found["frame"] = frame_message()
    return found


def operation(action, name, summary):
    return {
        "action": action, "channel": CHANNEL, "summary": summary,
        "messages": [{"$ref": f"#/channels/session/messages/{name}"}],
    }


def operations():
    found = {}
    for method, file in schemas.methods().items():
        summary = schemas.definitions(file)[method + ".params"]["description"]
        found[method] = operation("receive", method, summary)
        reply = {"$ref": f"#/channels/session/messages/{method}.reply"}
        found[method]["reply"] = {"channel": CHANNEL, "messages": [reply]}
    for event, definition in schemas.definitions("events").items():
        found[event] = operation("send", event, definition.get("description", "An event"))
    found["frame"] = operation("send", "frame", "The newest state, for subscribers")
    return found


def channel(names):
    protocol = {"type": "string", "const": "vat.v1"}
    headers = {"type": "object", "properties": {"Sec-WebSocket-Protocol": protocol}}
    return {
        "address": "/ws",
        "description": "Text messages are JSON-RPC 2.0, binary messages are frames of the server.",
        "messages": {name: {"$ref": f"#/components/messages/{name}"} for name in names},
        "bindings": {"ws": {"method": "GET", "headers": headers, "bindingVersion": "0.1.0"}},
    }


def document():
    components = messages()
    return {
        "asyncapi": "3.0.0",
        "info": {
            "title": "vat.v1", "version": "1.0.0", "license": {"name": "MIT"},
            "description": "The protocol of vat from the perspective of the server; see PROTOCOL.md.",
        },
        "defaultContentType": "application/json",
        "servers": {"local": {"host": "127.0.0.1:8080", "protocol": "ws"}},
        "channels": {"session": channel(components)},
        "operations": operations(),
        "components": {"messages": components},
    }


def text():
    return json.dumps(document(), indent=1) + "\n"
