"""The types of the messages in protocol/schemas/, as C++ types without text."""

import json
import re
from dataclasses import dataclass, field

SHARED = {"common", "errors", "events", "message", "scene_format"}
FREE = "Json"  # a value without a C++ type, for example a scene
MAX_U32 = 4294967295


@dataclass
class Member:
    name: str
    type: str
    remark: str
    is_optional: bool

    def declared(self):
        """Returns the type of the member. Json has its own empty value."""
        return f"std::optional<{self.type}>" if self.is_optional and self.type != FREE else self.type


@dataclass
class Enumeration:
    name: str  # with the structs that contain it: "SessionList::State"
    remark: str
    values: list


@dataclass
class Struct:
    name: str
    remark: str
    members: list = field(default_factory=list)
    inner: list = field(default_factory=list)  # enumerations and structs inside
    uses: list = field(default_factory=list)  # names of shared types


def camel(name):
    """Returns "ControlStep" for "control.step"."""
    return "".join(part[:1].upper() + part[1:] for part in re.split(r"[._]", name))


def read_schemas(folder):
    return {path.stem: json.loads(path.read_text("utf-8"))["$defs"]
            for path in sorted(folder.glob("*.json"))}


def words_of_range(schema):
    least, most = schema.get("minimum"), schema.get("maximum")
    if "exclusiveMinimum" in schema:
        return f"above {schema['exclusiveMinimum']}" + (f", at most {most}" if most else "")
    if most in (MAX_U32, None):
        return f"at least {least}" if least and schema["type"] == "integer" else ""
    return f"{least} to {most}" if least is not None else f"at most {most}"


def words_of_bounds(schema):
    """Returns the ranges that a schema permits, as words."""
    words = []
    if schema.get("type") in ("integer", "number"):
        words.append(words_of_range(schema))
    items = schema.get("items", {})
    if schema.get("minItems") == schema.get("maxItems") and items.get("type") == "number":
        bounds = words_of_range(items)
        words.append(bounds and f"each component {bounds}")
    elif "maxItems" in schema:
        words.append(f"at most {schema['maxItems']} elements")
    if "maxLength" in schema:
        words.append(f"at most {schema['maxLength']} bytes")
    if "default" in schema:
        words.append(f"default: {json.dumps(schema['default'])}")
    return [word for word in words if word]


class Types:
    """Shared and own types of all methods and events, in the order in which C++ needs them."""

    def __init__(self, schemas):
        self.schemas = schemas
        self.shared = {}  # name: Enumeration or Struct, each after the types that it uses

    def target(self, file, reference):
        home, _, name = reference.partition("#/$defs/")
        return (home.removesuffix(".json") or file), name

    def resolve(self, schema, file):
        """Returns a schema without references, its file, and its name if it has one."""
        name = None
        while "$ref" in schema:
            more = {key: value for key, value in schema.items() if key != "$ref"}
            file, name = self.target(file, schema["$ref"])
            schema = {**self.schemas[file][name], **more}
        return schema, file, name

    def add_shared(self, schema, file, name):
        """Returns the C++ name of a definition that several messages use."""
        title = camel(name)
        if title not in self.shared:
            original = self.schemas[file][name]
            made = self.make(original, file, title)
            self.shared[title] = made
        return title

    def make(self, schema, file, name):
        remark = schema.get("description", "")
        if "enum" in schema:
            return Enumeration(name, remark, schema["enum"])
        return self.struct(schema, file, name)

    def struct(self, schema, file, name):
        made = Struct(name, schema.get("description", ""))
        required = schema.get("required", [])
        for key, value in schema.get("properties", {}).items():
            kind, is_nullable = self.type_of(value, file, camel(key), made)
            resolved, _, _ = self.resolve(value, file)
            words = [resolved.get("description", "").rstrip("."), *words_of_bounds(resolved)]
            if kind == "Role" and "enum" in resolved and len(resolved["enum"]) < 4:
                words.append(" or ".join(resolved["enum"]))
            made.members.append(Member(key, kind, "; ".join(filter(None, words)),
                                       is_nullable or key not in required))
        return made

    def type_of(self, schema, file, title, owner):
        """Returns the C++ type, and whether the value can be null."""
        schema, file, name = self.resolve(schema, file)
        if file == "scene_format":
            return FREE, False
        if "oneOf" in schema:
            others = [option for option in schema["oneOf"] if option.get("type") != "null"]
            if len(others) == 1:
                return self.type_of(others[0], file, title, owner)[0], True
            return FREE, False
        if "enum" in schema:
            return self.enumeration(schema, file, name, title, owner), False
        kind = schema.get("type", "string")  # a const is a text
        if kind == "array":
            return self.array(schema, file, title, owner), False
        if kind == "object":
            return self.object(schema, file, name, title, owner), False
        return self.number(schema) if kind == "integer" else \
            {"string": "std::string", "boolean": "bool", "number": "double"}[kind], False

    def number(self, schema):
        if schema.get("minimum", -1) < 0:
            return "std::int64_t"
        return "std::uint32_t" if schema.get("maximum", MAX_U32 + 1) <= MAX_U32 else "std::uint64_t"

    def enumeration(self, schema, file, name, title, owner):
        if name:
            owner.uses.append(self.add_shared(schema, file, name))
            return owner.uses[-1]
        if set(schema["enum"]) <= set(self.schemas["common"]["role"]["enum"]):
            owner.uses.append(self.add_shared(schema, "common", "role"))
            return "Role"
        owner.inner.append(Enumeration(f"{owner.name}::{title}", "", schema["enum"]))
        return owner.inner[-1].name

    def array(self, schema, file, title, owner):
        items = schema["items"]
        size = schema.get("maxItems") if schema.get("minItems") == schema.get("maxItems") else None
        if items.get("type") == "number" and size == 3:
            return "Vec3"
        if items.get("type") == "number" and size is not None:
            return f"std::array<double, {size}>"
        return f"std::vector<{self.type_of(items, file, title + 'Item', owner)[0]}>"

    def object(self, schema, file, name, title, owner):
        if "properties" not in schema:
            inner, _ = self.type_of(schema["additionalProperties"], file, title, owner)
            return f"std::map<std::string, {inner}>"
        if name:
            owner.uses.append(self.add_shared(schema, file, name))
            return owner.uses[-1]
        made = self.struct(schema, file, f"{owner.name}::{title}")
        owner.inner.append(made)
        owner.uses += made.uses
        return made.name

    def message(self, file, name, title):
        """Returns the C++ name of a message's type, and its own type if no others share it."""
        schema = self.schemas[file][name]
        if "$ref" in schema:
            home, target = self.target(file, schema["$ref"])
            return self.add_shared(schema, home, target), None
        made = self.make(schema, file, title)
        return made.name, made


def methods_of(schemas):
    """Returns (file, name) of each method."""
    return [(file, key.removesuffix(".params")) for file, definitions in schemas.items()
            if file not in SHARED for key in definitions if key.endswith(".params")]
