"""Builds the wheel of this package (PEP 517) with CMake. It needs no other Python package."""

import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import tempfile
import tomllib
import zipfile
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]


def build_wheel(wheel_directory: str, config_settings: dict[str, Any] | None = None,
                metadata_directory: str | None = None) -> str:
    """Returns the name of the wheel in `wheel_directory`. The setting `package` is the folder of a
    package that is already built.
    """
    version = re.search(r"project\(vat VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())
    assert version is not None, "CMakeLists.txt states no version"
    with tempfile.TemporaryDirectory() as build:
        built = (config_settings or {}).get("package")
        files = package_files(Path(built) if built else build_package(Path(build)))
        return write_wheel(Path(wheel_directory), version[1], files)


def build_sdist(sdist_directory: str, config_settings: dict[str, Any] | None = None) -> str:
    raise NotImplementedError("vat is installed from its repository, which contains the core")


def build_package(build: Path) -> Path:
    """Builds the native part. Returns the folder of the package."""
    subprocess.run([
        "cmake", "-S", str(ROOT), "-B", str(build), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
        "-DCMAKE_CXX_FLAGS_RELEASE=-O2 -DNDEBUG", "-DVAT_BUILD_TESTS=OFF", "-DVAT_BUILD_PYTHON=ON",
        f"-DPython3_EXECUTABLE={sys.executable}"], check=True)
    subprocess.run(["cmake", "--build", str(build), "--target", "vat_python"], check=True)
    return build / "python" / "vat"


def package_files(package: Path) -> dict[str, bytes]:
    """Returns the contents of the files by their names in the wheel."""
    files = {}
    for folder, folders, names in os.walk(package, followlinks=True):
        folders[:] = [name for name in folders if name != "__pycache__"]
        if Path(folder) == package / "viewer":
            folders[:], names = ["export"], []  # the player of recordings
        for name in names:
            file = Path(folder) / name
            files[f"vat/{file.relative_to(package)}"] = file.read_bytes()
    return files


def write_wheel(folder: Path, version: str, files: dict[str, bytes]) -> str:
    project = tomllib.loads((HERE / "pyproject.toml").read_text())["project"]
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = re.sub(r"[-.]", "_", sysconfig.get_platform())
    tag = f"{python}-{python}-{platform}"
    info = f"vat-{version}.dist-info"
    metadata = [
        "Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {version}",
        f"Summary: {project['description']}", f"Requires-Python: {project['requires-python']}",
        *(f"Requires-Dist: {each}" for each in project["dependencies"])]
    kind = ["Wheel-Version: 1.0", "Generator: vat", "Root-Is-Purelib: false", f"Tag: {tag}"]
    files |= {f"{info}/METADATA": lines(metadata), f"{info}/WHEEL": lines(kind)}
    record = [f"{name},sha256={digest(content)},{len(content)}" for name, content in files.items()]
    files[f"{info}/RECORD"] = lines([*record, f"{info}/RECORD,,"])
    name = f"vat-{version}-{tag}.whl"
    with zipfile.ZipFile(folder / name, "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, content in files.items():
            wheel.writestr(path, content)
    return name


def lines(texts: list[str]) -> bytes:
    return "".join(f"{text}\n" for text in texts).encode()


def digest(content: bytes) -> str:
    return base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode().rstrip("=")
