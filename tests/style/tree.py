"""The text of a checkout, as used by the rules."""

import os
import subprocess
from dataclasses import dataclass, field

# The project's entries in the checkout if git is unavailable, without built or downloaded ones.
OUR_ENTRIES = {
    "core", "docker", "protocol", "server", "tests", "web", "vat", "CMakeLists.txt",
    "CMakePresets.json", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE", "README.md", ".ci",
    ".clang-format", ".clang-tidy", ".dockerignore", ".editorconfig", ".gitignore",
}
SKIPPED_FOLDERS = {"node_modules", "dist", "__pycache__"}
TEXT_ENDINGS = (
    ".cpp", ".h", ".ts", ".js", ".css", ".html", ".py", ".sh", ".cmake", ".md", ".json", ".jsonl",
    ".yaml", ".txt",
)
RAW_FOLDER = "tests/fuzz/corpus/"  # arbitrary bytes of a fuzzer with any extension
TEXT_NAMES = {
    "vat", "run", "Dockerfile", "LICENSE", ".clang-format", ".clang-tidy", ".editorconfig",
    ".gitignore", ".dockerignore", ".npmrc",
}


@dataclass
class Tree:
    """Files by path, relative to the root, with `/`. `paths` also contains binary files."""

    files: dict[str, str]
    paths: set[str] = field(default_factory=set)

    def __post_init__(self):
        self.paths = self.paths | set(self.files)

    def matching(self, folders, endings):
        """Returns (path, text) of the files in one of `folders` with one of `endings`."""
        for path, text in sorted(self.files.items()):
            if path.endswith(tuple(endings)) and path.startswith(tuple(folders)):
                yield path, text

    def has(self, path):
        """Returns whether there is a file or folder with this path."""
        return path in self.paths or any(p.startswith(path.rstrip("/") + "/") for p in self.paths)


def tracked_paths(root):
    """Returns the existing files that git tracks, or None if git cannot list them."""
    if not os.path.exists(os.path.join(root, ".git")):
        return None
    command = ["git", "-C", root, "ls-files", "-z"]
    try:
        listed = subprocess.run(command, check=True, capture_output=True).stdout
    except (OSError, subprocess.CalledProcessError):  # no git, or another user's folder
        return None
    paths = os.fsdecode(listed).split("\0")
    return [path for path in paths if os.path.isfile(os.path.join(root, path))]


def our_paths(root):
    """Returns the files below OUR_ENTRIES."""
    paths = []
    for folder, folders, names in os.walk(root):
        folders[:] = set(folders) - SKIPPED_FOLDERS
        if folder == root:
            folders[:] = set(folders) & OUR_ENTRIES
            names = set(names) & OUR_ENTRIES
        paths += [os.path.relpath(os.path.join(folder, name), root) for name in names]
    return paths


def is_text(path):
    name = os.path.basename(path)
    return (name.endswith(TEXT_ENDINGS) or name in TEXT_NAMES) and not path.startswith(RAW_FOLDER)


def read_tree(root):
    """Reads the project's files below `root`. Other files of a user are excluded."""
    paths = tracked_paths(root)
    if paths is None:
        paths = our_paths(root)
    files = {}
    for path in filter(is_text, paths):
        with open(os.path.join(root, path), encoding="utf-8", errors="replace", newline="") as file:
            files[path] = file.read()
    return Tree(files, set(paths))
