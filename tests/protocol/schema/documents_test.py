"""Checks the schemas and the AsyncAPI document: valid, complete and without unused parts.

VAT_UPDATE_GOLDEN=1 rewrites protocol/asyncapi.json.
"""

import json
import os
import re
import unittest

import asyncapi
import schemas
from jsonschema import Draft202012Validator

SCENES = schemas.ROOT / "protocol" / "scenes"
NAME = re.compile(r"^[a-zA-Z0-9._-]+$")
ACTIONS = {"send", "receive"}


class Schemas(unittest.TestCase):
    def test_are_valid(self):
        for name, file in schemas.files().items():
            with self.subTest(name):
                self.assertEqual(file["$schema"], "https://json-schema.org/draft/2020-12/schema")
                for definition in file["$defs"].values():
                    Draft202012Validator.check_schema(definition)

    def test_refer_to_what_is_there(self):
        for name, file in schemas.files().items():
            for reference in schemas.references(file):
                with self.subTest(f"{name}: {reference}"):
                    where, definition = schemas.resolve(reference, name)
                    self.assertIn(definition, schemas.definitions(where))

    def test_have_each_method_in_the_file_of_its_group(self):
        for method, name in schemas.methods().items():
            with self.subTest(method):
                self.assertEqual(method.split(".")[0], name)
                self.assertIn(method + ".result", schemas.definitions(name))
                self.assertTrue(schemas.definitions(name)[method + ".params"]["description"])

    def test_refuse_unknown_parameters(self):
        for method, name in schemas.methods().items():
            with self.subTest(method):
                reason = schemas.fault({"no such": 1}, name, method + ".params")
                self.assertRegex(reason or "", "no such|required")

    def test_define_nothing_that_is_not_used(self):
        used = {
            schemas.resolve(reference, name)
            for name, file in schemas.files().items() for reference in schemas.references(file)
        }
        for name in schemas.files():
            for definition in schemas.definitions(name):
                public = re.search(r"\.(params|result)$", definition) or name in {
                    "events", "message"}
                with self.subTest(f"{name}: {definition}"):
                    self.assertTrue(public or (name, definition) in used)

    def test_hold_for_the_catalogue(self):
        paths = sorted(SCENES.glob("*.json"))
        self.assertTrue(paths)
        for path in paths:
            with self.subTest(path.name):
                scene = json.loads(path.read_text("utf-8"))
                self.assertIsNone(schemas.fault(scene, "scene_format", "scene"))
                scene["bodies"][0]["colour"] = "red"
                self.assertIsNotNone(schemas.fault(scene, "scene_format", "scene"))

    def test_hold_for_the_documented_scene(self):
        text = (schemas.ROOT / "protocol" / "SCENE.md").read_text("utf-8")
        scene = json.loads(re.search(r"```json\n(.*?)```", text, re.DOTALL)[1])
        self.assertIsNone(schemas.fault(scene, "scene_format", "scene"))


class AsyncApi(unittest.TestCase):
    def setUp(self):
        if os.environ.get("VAT_UPDATE_GOLDEN"):
            asyncapi.DOCUMENT.write_text(asyncapi.text(), "utf-8")
        self.text = asyncapi.DOCUMENT.read_text("utf-8")
        self.document = json.loads(self.text)

    def pointed(self, reference):
        node = self.document
        for part in reference.removeprefix("#/").split("/"):
            node = node[part.replace("~1", "/").replace("~0", "~")]
        return node

    def test_is_what_the_schemas_say(self):
        self.assertEqual(self.text, asyncapi.text())

    def test_refers_to_what_is_there(self):
        for reference in schemas.references(self.document):
            with self.subTest(reference):
                file, _, definition = reference.partition("#/$defs/")
                if file.startswith("schemas/"):
                    name = file.removeprefix("schemas/").removesuffix(".json")
                    self.assertIn(definition, schemas.definitions(name))
                else:
                    self.assertTrue(self.pointed(reference))

    def test_has_the_structure_of_version_3(self):
        self.assertRegex(self.document["asyncapi"], r"^3\.\d+\.\d+$")
        self.assertLessEqual({"title", "version"}, set(self.document["info"]))
        known = {"asyncapi", "info", "defaultContentType", "servers", "channels", "operations",
                 "components"}
        self.assertLessEqual(set(self.document), known)
        for server in self.document["servers"].values():
            self.assertLessEqual({"host", "protocol"}, set(server))
        for channel in self.document["channels"].values():
            self.assertLessEqual({"address", "messages"}, set(channel))
            self.assertTrue(all(map(NAME.match, channel["messages"])))

    def test_has_an_operation_for_every_message(self):
        offered = self.document["channels"]["session"]["messages"]
        carried = set()
        for name, operation in self.document["operations"].items():
            with self.subTest(name):
                self.assertRegex(name, NAME)
                self.assertIn(operation["action"], ACTIONS)
                self.assertEqual(self.pointed(operation["channel"]["$ref"])["address"], "/ws")
                reply = operation.get("reply", {}).get("messages", [])
                self.assertEqual(bool(reply), operation["action"] == "receive")
                for message in operation["messages"] + reply:
                    carried.add(message["$ref"].rsplit("/", 1)[1])
        self.assertEqual(carried, set(offered))
        self.assertEqual(set(offered), set(self.document["components"]["messages"]))

    def test_has_a_schema_for_every_message(self):
        for name, message in self.document["components"]["messages"].items():
            with self.subTest(name):
                self.assertEqual(message["name"], name)
                Draft202012Validator.check_schema(message["payload"]["schema"])


if __name__ == "__main__":
    unittest.main()
