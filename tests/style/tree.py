"""The text of a checkout, as the rules see it."""

import os
from dataclasses import dataclass, field

SKIPPED_FOLDERS = {".git", "build", "node_modules", "dist", "__pycache__", ".cache"}
TEXT_ENDINGS = (
    ".cpp", ".h", ".ts", ".js", ".css", ".html", ".py", ".sh", ".cmake", ".md", ".json", ".jsonl",
    ".yaml", ".txt",
)
RAW_FOLDER = "tests/fuzz/corpus/"  # bytes as a fuzzer gives them, whatever they are called
TEXT_NAMES = {
    "vat", "run", "Dockerfile", "LICENSE", ".clang-format", ".clang-tidy", ".editorconfig",
    ".gitignore", ".dockerignore", ".npmrc",
}


@dataclass
class Tree:
    """Files by path, relative to the root, with `/`. `paths` has those too that are not text."""

    files: dict[str, str]
    paths: set[str] = field(default_factory=set)

    def __post_init__(self):
        self.paths = self.paths | set(self.files)

    def matching(self, folders, endings):
        """(path, text) of the files below one of `folders` that end in one of `endings`."""
        for path, text in sorted(self.files.items()):
            if path.endswith(tuple(endings)) and path.startswith(tuple(folders)):
                yield path, text

    def has(self, path):
        """Whether there is a file or a folder of that name."""
        return path in self.paths or any(p.startswith(path.rstrip("/") + "/") for p in self.paths)


def read_tree(root):
    """The files below `root`, apart from what is built or fetched."""
    files, paths = {}, set()
    for folder, folders, names in os.walk(root):
        folders[:] = sorted(set(folders) - SKIPPED_FOLDERS)
        for name in names:
            full = os.path.join(folder, name)
            path = os.path.relpath(full, root).replace(os.sep, "/")
            paths.add(path)
            is_text = name.endswith(TEXT_ENDINGS) or name in TEXT_NAMES
            if is_text and not path.startswith(RAW_FOLDER):
                with open(full, encoding="utf-8") as file:
                    files[path] = file.read()
    return Tree(files, paths)
