"""The order of the folders: a folder includes itself and the folders before it only."""

import posixpath
import re

INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)

# The lowest first. Each line is a floor of the architecture.
FOLDER_ORDER = (
    # constants, containers, kernels
    "core", "core/support", "core/threads", "core/kernels",
    # scene values, and formulas of forces
    "core/scene", "core/laws",
    # sampling of shapes; step and integrator for a scene; checks
    "core/neighbours", "core/sampling", "core/numerics", "core/validation",
    # stages of a step without physics; the compiled scene; integrated state
    "core/stage", "core/model", "core/state", "core/evaluation", "core/guard",
    # the methods
    "core/liquid/pairs", "core/liquid/gas", "core/liquid/tait",
    "core/liquid/surface", "core/contact", "core/contact/projection", "core/solid", "core/rigid",
    "core/external", "core/liquid/incompressible", "core/damping",
    # the step, and the simulation
    "core/stepping/control", "core/stepping", "core/sleep", "core/saved", "core/simulation", "core/coupling",
    # steps on other devices
    "core/device/opencl", "core/device/common", "core/device/contact", "core/device/liquid", "core/device/solid", "core/device/gas",
    "core/device/tait", "core/device/incompressible", "core/device",
    "protocol/json", "protocol/files", "protocol/scene", "protocol/convert", "protocol/tune", "protocol/published", "protocol/frame",
    "protocol/messages", "protocol/recording", "protocol/python/native",
    # the client library
    "protocol/client/connection", "protocol/client/methods", "protocol/client/exchange", "protocol/client",
    # files, sockets and measurements, without sessions
    "server/support", "server/nats", "server/output/mesh", "server/output", "server/output/alembic", "server/storage/sqlite", "server/storage/saved", "server/storage", "server/access", "server/transport",
    "server/operations", "server/messages", "server/http",
    # the parts of a session
    "server/clients", "server/frames", "server/relay", "server/recording", "server/people", "server/history", "server/cluster/saved", "server/cluster", "server/session/ticks",
    "server/session/core", "server/session", "server/replay", "server/directory",
    # the interface of clients
    "server/methods", "server/rpc",
    # the programs
    "server/script", "server/settings", "server/cli/common", "server/cli/serve", "server/cli/simulate", "server/cli/tune", "server/cli/record",
    "server/cli",
    "server",
)


def folder_order(tree):
    floors = {folder: floor for floor, folder in enumerate(FOLDER_ORDER)}
    faults = []
    for path, text in tree.matching(["core/", "protocol/", "server/"], (".cpp", ".h")):
        folder = posixpath.dirname(path)
        if folder not in floors:
            faults.append(f"{path}: FOLDER_ORDER does not have {folder}")
            continue
        for header in INCLUDE.findall(text):
            included = posixpath.dirname(header)
            if floors.get(included, len(floors)) > floors[folder]:
                faults.append(f"{path}: {folder} may not include {header}")
    return faults


RULES = (folder_order,)
