"""generate.py SCHEMAS FOLDER: writes methods.h and methods.cpp, the typed methods and events of vat.v1.

SCHEMAS is protocol/schemas. An unchanged file keeps its time.
"""

import sys
import textwrap
from pathlib import Path

sys.dont_write_bytecode = True

from schemas import FREE, Enumeration, Types, camel, methods_of, read_schemas

WIDTH = 100
BANNER = "// Written from protocol/schemas/ by generate.py; not to be edited.\n"
HEADER = """#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/types.h"

/// Typed methods and events of the protocol vat.v1. protocol/PROTOCOL.md specifies them. Units are
/// SI. Members that are optional in the protocol are std::optional. A null Json is an absent member.
namespace vat::client {

using Json = nlohmann::json;

"""
SOURCE = """#include "protocol/client/methods/methods.h"

#include "protocol/client/methods/json_value.h"

namespace vat::client {

"""
END = "}  // namespace vat::client\n"


def remark(text, indent):
    """Returns lines of a documentation comment."""
    if not text:
        return []
    text = text[:1].upper() + text[1:]
    if not text.endswith((".", "]")):
        text += "."
    return textwrap.wrap(text, WIDTH, initial_indent=f"{indent}/// ",
                         subsequent_indent=f"{indent}/// ", break_long_words=False)


def local(name):
    return name.rpartition("::")[2]


def default_of(member, enumerations):
    kind = member.declared()
    if kind == "bool":
        return " = false"
    if kind in ("double", "std::int64_t", "std::uint32_t", "std::uint64_t"):
        return " = 0"
    if kind == "Vec3":
        return " = Vec3::Zero()"
    if kind in enumerations:
        return f" = {kind}::{enumerations[kind].values[0]}"
    return " = {}"


class Writer:
    def __init__(self, schemas):
        self.types = Types(schemas)
        self.enumerations = {}
        self.written, self.read = {}, {}  # types of params, and of results and events, by name
        self.methods = [self.method(file, name) for file, name in methods_of(schemas)]
        self.events = [(name, *self.types.message("events", name, camel(name) + "Event"))
                       for name in schemas["events"]]

    def method(self, file, name):
        title = camel(name)
        params = self.types.message(file, f"{name}.params", f"{title}::Params")
        result = self.types.message(file, f"{name}.result", f"{title}::Result")
        described = self.types.schemas[file][f"{name}.params"].get("description", "")
        return name, title, described, params, result

    # --- declarations ---

    def declare(self, item, depth):
        indent = "  " * depth
        if isinstance(item, Enumeration):
            self.enumerations[item.name] = item
            yield from remark(item.remark, indent)
            yield f"{indent}enum class {local(item.name)} {{ {', '.join(item.values)}, unknown }};"
            return
        if depth == 0 or not item.name.endswith(("::Params", "::Result")):
            yield from remark(item.remark, indent)
        if not item.members:
            yield f"{indent}struct {local(item.name)} {{}};"
            return
        yield f"{indent}struct {local(item.name)} {{"
        for inner in item.inner:
            yield from self.declare(inner, depth + 1)
        for member in item.members:
            yield from remark(member.remark, indent + "  ")
            kind = member.declared()
            yield f"{indent}  {kind} {member.name}{default_of(member, self.enumerations)};"
        yield f"{indent}}};"

    def declare_method(self, name, title, described, params, result):
        yield from remark(f"Method {name}. {described}", "")
        yield f"struct {title} {{"
        yield f'  static constexpr const char* kName = "{name}";'
        for label, (kind, own) in (("Params", params), ("Result", result)):
            yield from self.declare(own, 1) if own else [f"  using {label} = {kind};"]
        yield "};"

    def all_items(self):
        yield from self.types.shared.values()
        for _, _, _, params, result in self.methods:
            yield from (own for _, own in (params, result) if own)
        yield from (own for _, _, own in self.events if own)

    def header(self):
        yield "// The last enumerator of each enumeration, `unknown`, is a value of a later version."
        yield ""
        for item in self.types.shared.values():
            yield from self.declare(item, 0)
            yield ""
        for method in self.methods:
            yield from self.declare_method(*method)
            yield ""
        for name, _, own in self.events:
            if own:
                own.remark = f"Event {name}. {own.remark}"
                yield from self.declare(own, 0)
                yield ""
        yield "/// A function for each event. Events without a function are ignored."
        yield "struct EventHandlers {"
        for name, kind, _ in self.events:
            yield f"  std::function<void(const {kind}&)> {name.replace('.', '_')} = {{}};"
        yield "};"
        yield ""
        yield "/// Calls the function of an event. Returns false if the protocol does not have the event."
        yield "/// Throws InvalidValue (json_value.h) if `params` do not conform to the event."
        yield ("bool deliver_event(const std::string& name, const Json& params, "
               "const EventHandlers& handlers);")
        yield ""
        yield "/// Write params, and read results and events. write_json() throws"
        yield "/// std::invalid_argument for an enumerator `unknown`."
        for kind in self.directed(3):
            yield f"void write_json(Json& json, const {kind}& value);"
        for kind in sorted({*self.directed(4), *(kind for _, kind, _ in self.events)}):
            yield f"void read_json(const Json& json, {kind}& value);"
        yield ""

    def directed(self, part):
        """Returns the types of all params (3) or of all results (4)."""
        return sorted({method[part][0] for method in self.methods})

    # --- definitions ---

    def reachable(self, roots):
        """Returns the names of all structs and enumerations inside the types."""
        items = {}

        def list_inner(item):
            items[item.name] = item
            for inner in getattr(item, "inner", ()):
                list_inner(inner)

        for item in self.all_items():
            list_inner(item)
        found = {}

        def visit(name):
            if name in items and name not in found:
                found[name] = items[name]
                for member in getattr(items[name], "members", ()):
                    for part in member.type.replace("<", " ").replace(">", " ").replace(",", " ").split():
                        visit(part)

        for root in roots:
            visit(root)
        return found

    def source(self):
        written = self.reachable(self.directed(3))
        read = self.reachable([*self.directed(4), *(kind for _, kind, _ in self.events)])
        for name, item in sorted({**written, **read}.items()):
            if isinstance(item, Enumeration):
                names = ", ".join(f'"{value}"' for value in item.values)
                yield "template <>"
                yield f"inline constexpr std::array kTexts<{name}>{{{names}}};"
        yield ""
        yield "// Functions of nested types are used before their definition."
        for form, items in (("void write_json(Json& json, const {}& value);", written),
                            ("void read_json(const Json& json, {}& value);", read)):
            yield from (form.format(name) for name, item in items.items()
                        if not isinstance(item, Enumeration))
        yield ""
        for name, item in written.items():
            yield from self.define(item, f"void write_json([[maybe_unused]] Json& json, [[maybe_unused]] const {name}& value)",
                                   "write_member")
        for name, item in read.items():
            yield from self.define(item, f"void read_json(const Json& json, [[maybe_unused]] {name}& value)",
                                   "read_member")
        yield ("bool deliver_event(const std::string& name, const Json& params, "
               "const EventHandlers& handlers) {")
        for name, _, _ in self.events:
            member = name.replace(".", "_")
            yield f'  if (name == "{name}") return deliver(params, handlers.{member});'
        yield "  return false;"
        yield "}"
        yield ""

    def define(self, item, head, function):
        if isinstance(item, Enumeration):
            return
        yield f"{head} {{"
        if function == "write_member":
            yield "  json = Json::object();"
        else:
            yield "  require_object(json);"
        for member in item.members:
            is_free = member.is_optional and member.type == FREE and function == "read_member"
            name = "read_free_member" if is_free else function
            yield f'  {name}(json, "{member.name}", value.{member.name});'
        yield "}"
        yield ""


def write_if_changed(path, lines):
    text = BANNER + "".join(lines) + END
    if not path.exists() or path.read_text("utf-8") != text:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")


def main():
    schemas, folder = map(Path, sys.argv[1:])
    writer = Writer(read_schemas(schemas))
    header = [HEADER, *(line + "\n" for line in writer.header())]
    write_if_changed(folder / "methods.h", header)
    write_if_changed(folder / "methods.cpp", [SOURCE, *(line + "\n" for line in writer.source())])


if __name__ == "__main__":
    main()
