"""site_test.py ROOT: makes the sources of the documentation site, as `./vat prepare docs` does.

Sphinx and Doxygen, which turn them into pages, report their own errors.
"""

import importlib
import os
import re
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "web" / "site"))

import stage
import vat

ROOT = Path(sys.argv[1])
#: Documents for developers of vat, which only the repository shows.
NOT_ON_SITE = re.compile(r"(tests|web/site|\.\w+|build|web/node_modules)/")
LINK = re.compile(r"\]\(([^)#\s]+)[^)]*\)")


class Site(unittest.TestCase):
    def test_all_documents_for_users_are_on_it(self) -> None:
        on_site = {document.relative_to(ROOT).as_posix() for document in stage.documents(ROOT)}
        written = {path.relative_to(ROOT).as_posix() for path in ROOT.rglob("*.md")}
        written = {name for name in written
                   if not NOT_ON_SITE.match(name) and "/node_modules/" not in name}
        self.assertEqual(on_site - {"web/site/tutorial.md"}, written)

    def test_links_lead_to_staged_files(self) -> None:
        documents = stage.documents(ROOT)
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            for document in documents:
                stage.stage_document(document, ROOT, folder, set(documents))
            links = 0
            for document in folder.rglob("*.md"):
                text = stage.FENCE.sub("", document.read_text("utf-8"))
                for link in LINK.findall(text):
                    if "://" in link:
                        continue
                    links += 1
                    target = Path(os.path.normpath(document.parent / link))
                    self.assertTrue(target.is_file(), f"{document.relative_to(folder)}: {link}")
            self.assertGreater(links, 0)

    def test_python_reference_has_all_public_names(self) -> None:
        reference = stage.python_reference()
        modules = re.findall(r"automodule:: (\S+)", reference)
        shown = {name for module in map(importlib.import_module, modules)
                 for name, value in vars(module).items()
                 if getattr(value, "__module__", module.__name__) == module.__name__}
        shown |= set(re.findall(r"auto(?:exception|function):: vat\.(\w+)", reference))
        self.assertEqual(set(vat.__all__) - shown, set())

    def test_cpp_reference_has_existing_headers(self) -> None:
        for header in stage.HEADERS:
            self.assertTrue((ROOT / header).is_file(), header)

    def test_protocol_reference_has_all_operations(self) -> None:
        reference = stage.ProtocolReference(ROOT / "protocol")
        text = reference.text()
        for operation in reference.asyncapi["operations"]:
            self.assertIn(f"## {operation}\n", text)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
