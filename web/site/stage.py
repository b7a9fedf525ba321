"""stage.py ROOT FOLDER XML: makes the sources of the documentation site in FOLDER.

The documents keep their places in the repository, so that links between them work. Links to folders
and to files that are not documents become plain text. The references are generated; XML is the
output of Doxygen.
"""

import json
import os
import re
import shutil
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

#: Headers of the C++ reference: the classes of a program that runs simulations.
HEADERS = (
    "core/simulation/simulation.h", "core/simulation/host_interface.h",
    "core/simulation/body_values.h", "core/simulation/numerics_change.h",
    "core/simulation/snapshot.h", "core/diagnostics.h",
    "core/coupling/coupled_simulation.h", "core/coupling/external_body.h",
    "core/stage/advance_report.h", "core/scene/scene.h", "core/scene/body.h",
    "core/scene/material.h", "core/scene/interface.h", "core/scene/numerics.h",
    "core/scene/world.h", "core/support/result.h", "core/support/parallel.h",
    "core/support/instruction_set.h", "core/threads/thread_pool.h", "core/limits.h",
    "core/types.h", "protocol/scene/scene_json.h", "protocol/frame/frame_codec.h",
    "protocol/client/client.h", "protocol/client/exchange/options.h",
    "protocol/client/exchange/frame.h", "protocol/client/exchange/call_error.h",
)
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")
FENCE = re.compile(r"(^```.*?^```)", re.MULTILINE | re.DOTALL)


def documents(root: Path) -> list[Path]:
    """Returns the documents of the repository, without those about its tests."""
    index = (root / "web" / "site" / "index.md").read_text("utf-8")
    trees = re.findall(r"^```\{toctree\}\n(.*?)^```", index, re.MULTILINE | re.DOTALL)
    names = re.findall(r"^(?:.*<)?(\w[\w/]*)>?$", "\n".join(trees), re.MULTILINE)
    return [root / f"{name}.md" for name in names if not name.startswith("reference/")]


def stage_document(document: Path, root: Path, folder: Path, known: set[Path]) -> None:
    """Writes a document with the links that exist on the site, and copies its pictures."""
    target = folder / document.relative_to(root)
    target.parent.mkdir(parents=True, exist_ok=True)

    def link(match: re.Match[str]) -> str:
        mark, text, address = match.groups()
        if "://" in address or address.startswith("#"):
            return match[0]
        linked = Path(os.path.normpath(document.parent / address.partition("#")[0]))
        if mark and linked.is_file():
            copy = folder / linked.relative_to(root)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(linked, copy)
            return match[0]
        return match[0] if linked in known else text

    parts = FENCE.split(document.read_text("utf-8"))
    text = "".join(part if part.startswith("```") else LINK.sub(link, part) for part in parts)
    target.write_text(text, "utf-8")


def python_reference() -> str:
    modules = ("simulation", "recording", "client", "async_client", "session", "frames", "results",
               "scenes", "errors", "exchange")
    parts = ["# Python reference\n\nThe package `vat` exports the public names of these modules.\n"]
    parts += [f"## vat.{name}\n\n```{{eval-rst}}\n.. automodule:: vat.{name}\n```\n"
              for name in modules]
    parts.append("## Others\n\n```{eval-rst}\n.. autoexception:: vat.Closed\n\n"
                 ".. autofunction:: vat.frame_number\n```\n")
    return "\n".join(parts)


def is_outer(name: str) -> bool:
    """Returns whether a name is directly in a namespace."""
    return name.removeprefix("vat::client::").removeprefix("vat::").count("::") == 0


class CppReference:
    """Classes, enumerations and functions of HEADERS, from the XML of Doxygen."""

    def __init__(self, xml: Path) -> None:
        self.files = {}
        for file in xml.glob("*_8h.xml"):
            compound = ElementTree.parse(file).getroot().find("compounddef")
            assert compound is not None
            location = compound.find("location")
            assert location is not None
            self.files[location.attrib["file"]] = compound

    def directives(self, header: str) -> list[str]:
        compound = self.files[header]
        found = []
        for inner in compound.findall("innerclass"):
            name = inner.text or ""
            kind = "class" if inner.attrib["refid"].startswith("class") else "struct"
            # A nested class is shown with its outer class, and a specialisation with its template.
            if is_outer(name) and "<" not in name:
                found.append(f"```{{doxygen{kind}}} {name}\n:members:\n```\n")
        for member in compound.iter("memberdef"):
            kind, name = member.attrib["kind"], member.findtext("qualifiedname") or ""
            if kind == "enum" and is_outer(name):
                found.append(f"```{{doxygenenum}} {name}\n```\n")
            elif kind == "function" and is_outer(name) and "operator" not in name:
                arguments = member.findtext("argsstring") or ""
                found.append(f"```{{doxygenfunction}} {name}{arguments}\n```\n")
        return found

    def text(self) -> str:
        parts = ["# C++ reference\n\nThe library of the physics (`find_package(vat COMPONENTS core)`), "
                 "the readers of scenes and frames, and the client library (`COMPONENTS client`).\n"]
        for header in HEADERS:
            parts.append(f"## {header}\n")
            parts += self.directives(header)
        return "\n".join(parts)


class ProtocolReference:
    """Tables of all messages, from asyncapi.json and the schemas."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.asyncapi = self.read("asyncapi.json")

    def read(self, name: str) -> Any:
        return json.loads((self.folder / name).read_text("utf-8"))

    def resolve(self, schema: Any, file: str) -> tuple[Any, str]:
        """Follows references. Returns the schema and the file that contains it."""
        while "$ref" in schema:
            name, _, pointer = schema["$ref"].partition("#")
            file = os.path.normpath(os.path.join(os.path.dirname(file), name)) if name else file
            schema = self.read(file)
            for key in pointer.strip("/").split("/"):
                if key:
                    schema = schema[key.replace("~1", "/").replace("~0", "~")]
        return schema, file

    def kind(self, schema: Any, file: str) -> str:
        """Returns the type and the range of a value."""
        schema, file = self.resolve(schema, file)
        if "const" in schema:
            return f"`{json.dumps(schema['const'])}`"
        if "enum" in schema:
            return ", ".join(f"`{json.dumps(value)}`" for value in schema["enum"])
        for key in ("anyOf", "oneOf"):
            if key in schema:
                return " or ".join(dict.fromkeys(self.kind(each, file) for each in schema[key]))
        text = schema.get("type", "any value")
        text = " or ".join(text) if isinstance(text, list) else text
        if text == "array" and "items" in schema:
            text = f"array of {self.kind(schema['items'], file)}"
        low = schema.get("minimum", schema.get("exclusiveMinimum"))
        high = schema.get("maximum", schema.get("exclusiveMaximum"))
        if low is not None or high is not None:
            text += f", {'' if low is None else low} to {'' if high is None else high}"
        return text

    def table(self, schema: Any, file: str) -> str:
        """Returns the members of an object as a table."""
        schema, file = self.resolve(schema, file)
        members = schema.get("properties", {})
        if not members:
            return "–\n"
        required = schema.get("required", [])
        rows = ["| member | value | |", "|---|---|---|"]
        for name, member in members.items():
            resolved, _ = self.resolve(member, file)
            about = member.get("description") or resolved.get("description", "")
            optional = "" if name in required else " (optional)"
            kind = self.kind(member, file).replace("|", "\\|")
            rows.append(f"| `{name}`{optional} | {kind} | {about} |")
        return "\n".join(rows) + "\n"

    def payload(self, name: str, member: str) -> str:
        message = self.asyncapi["components"]["messages"].get(name)
        if message is None:
            return "–\n"
        schema, file = self.resolve(message["payload"]["schema"], "asyncapi.json")
        part = schema.get("properties", {}).get(member)
        return "–\n" if part is None else self.table(part, file)

    def text(self) -> str:
        parts = ["# Messages\n\nAll messages of vat.v1, from asyncapi.json and its schemas. "
                 "[PROTOCOL](../protocol/PROTOCOL.md) explains them.\n"]
        for name, operation in self.asyncapi["operations"].items():
            parts.append(f"## {name}\n\n{operation.get('summary', '')}\n")
            parts.append(f"**Params**\n\n{self.payload(name, 'params')}")
            if "reply" in operation:
                parts.append(f"**Result**\n\n{self.payload(name + '.reply', 'result')}")
        return "\n".join(parts)


def main() -> None:
    root, folder = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "reference").mkdir(parents=True)
    found = documents(root)
    for document in found:
        stage_document(document, root, folder, set(found))
    shutil.copyfile(root / "web" / "site" / "index.md", folder / "index.md")
    references = {"python": python_reference(), "cpp": CppReference(Path(sys.argv[3])).text(),
                  "protocol": ProtocolReference(root / "protocol").text()}
    for name, text in references.items():
        (folder / "reference" / f"{name}.md").write_text(text, "utf-8")
    print(len(found), "documents")


if __name__ == "__main__":
    main()
