"""The schemas in protocol/schemas/ as one document, and validators of their definitions."""

import copy
import functools
import json
from pathlib import Path

from jsonschema import Draft202012Validator
from jsonschema.exceptions import best_match

ROOT = Path(__file__).resolve().parents[3]
FOLDER = ROOT / "protocol" / "schemas"
# Files without methods.
SHARED = {"common", "errors", "events", "message", "scene_format"}


@functools.cache
def files():
    """Returns the files by name without extension."""
    return {path.stem: json.loads(path.read_text("utf-8")) for path in sorted(FOLDER.glob("*.json"))}


def definitions(name):
    return files()[name]["$defs"]


@functools.cache
def methods():
    """Returns {method: name of its file} from the definitions METHOD.params and METHOD.result."""
    return {
        definition.removesuffix(".params"): name
        for name in files() if name not in SHARED
        for definition in definitions(name) if definition.endswith(".params")
    }


def resolve(reference, name):
    """Returns the target of a reference in the file `name`: (file, definition)."""
    file, _, definition = reference.partition("#/$defs/")
    return file.removesuffix(".json") or name, definition


def references(node):
    """Returns all values of $ref in a document."""
    if isinstance(node, dict):
        if isinstance(node.get("$ref"), str):
            yield node["$ref"]
        node = node.values()
    if not isinstance(node, str):
        for child in node if hasattr(node, "__iter__") else ():
            yield from references(child)


def localised(node, name, closed):
    """Returns the schema with references within the one document. If `closed`, objects have only
    members of the schema.
    """
    if isinstance(node, list):
        return [localised(child, name, closed) for child in node]
    if not isinstance(node, dict):
        return node
    result = {key: localised(child, name, closed) for key, child in node.items()}
    if isinstance(node.get("$ref"), str):
        file, definition = resolve(node["$ref"], name)
        result["$ref"] = f"#/$defs/{file}/$defs/{definition}"
    if closed and isinstance(node.get("properties"), dict) and node.get("type") == "object":
        result.setdefault("additionalProperties", False)
    return result


@functools.cache
def bundle(closed):
    """Returns all files as definitions of one document, so that references are local."""
    return {name: localised(copy.deepcopy(file), name, closed) for name, file in files().items()}


@functools.cache
def validator(name, definition, closed=False):
    return Draft202012Validator(
        {"$defs": bundle(closed), "$ref": f"#/$defs/{name}/$defs/{definition}"})


def fault(value, name, definition, closed=False):
    """Returns the reason why the value does not match the definition, or None."""
    return text_fault(json.dumps(value), name, definition, closed)


# Many messages of the tests are equal.
@functools.cache
def text_fault(text, name, definition, closed):
    error = best_match(validator(name, definition, closed).iter_errors(json.loads(text)))
    if error is None:
        return None
    place = "".join(f"/{part}" for part in error.absolute_path) or "the top"
    return f"{name}.json {definition}: at {place}: {error.message[:300]}"
