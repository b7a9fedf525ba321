"""Scenes: dictionaries in the format of a scene file (protocol/SCENE.md)."""

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from vat import _native

#: A scene, its file, or its name in the catalogue.
SceneSource = Mapping[str, Any] | str | os.PathLike[str]

FOLDER = Path(__file__).parent / "scenes"


def scene_names() -> list[str]:
    """Returns the names of the catalogue."""
    return sorted(file.stem for file in FOLDER.glob("*.json"))


def load_scene(source: SceneSource, level: str = "normal") -> dict[str, Any]:
    """Returns a scene as a dictionary. Meshes are inline.

    `level` is coarse, normal, fine or finest: the same physics with another distance of particles.
    Raises InputError if the scene is invalid or has no such level.
    """
    text, folder = scene_text(source)
    scene: dict[str, Any] = json.loads(_native.at_level(text, folder, level))
    return scene


def scene_text(source: SceneSource) -> tuple[str, str]:
    """Returns the JSON text of a scene, and the folder of its meshes."""
    if isinstance(source, Mapping):
        return json.dumps(source), "."
    file = Path(source)
    if isinstance(source, str) and "/" not in source and file.suffix != ".json":
        file = catalogue_file(source)
    return _native.read_scene_file(str(file)), str(file.parent)


def catalogue_file(name: str) -> Path:
    names = scene_names()
    if name in names:
        return FOLDER / f"{name}.json"
    _native.refuse_unknown_scene(name, names)
