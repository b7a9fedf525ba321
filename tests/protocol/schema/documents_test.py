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
    def test_has_the_content_of_the_schemas(self):
        if os.environ.get("VAT_UPDATE_GOLDEN"):
            asyncapi.DOCUMENT.write_text(asyncapi.text(), "utf-8")
        self.assertEqual(asyncapi.DOCUMENT.read_text("utf-8"), asyncapi.text())


if __name__ == "__main__":
    unittest.main()
