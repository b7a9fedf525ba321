"""deployment_test.py VAT FOLDER: the files for containers in docker/ agree with each other and with
the server. No test machine has a container engine.
"""

import os
import re
import subprocess
import sys
import unittest
import urllib.request
from pathlib import Path

import yaml

PROGRAM, FOLDER = sys.argv[1], Path(sys.argv[2])

OTHER_VARIABLES = {"VAT_ADMIN_TOKEN"}  # not an option, so that lists of processes do not show it


def documents(name):
    return [item for item in yaml.safe_load_all((FOLDER / name).read_text()) if item]


def by_kind(items, kind):
    return [item for item in items if item["kind"] == kind]


def variables(item):
    """Returns the names and values of all variables VAT_... in a document."""
    found = {}
    if isinstance(item, dict):
        if str(item.get("name", "")).startswith("VAT_"):
            found[item["name"]] = item.get("value")
        for key, value in item.items():
            if str(key).startswith("VAT_"):
                found[key] = value
            found.update(variables(value))
    elif isinstance(item, list):
        for part in item:
            found.update(variables(part))
    return found


class Deployment(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        text = subprocess.run([PROGRAM, "serve", "--help"], capture_output=True, text=True,
                              check=True).stdout
        options = re.findall(r"^ +(?:-\w, *)?--([a-z-]+)", text, re.MULTILINE)
        cls.settings = {"VAT_" + option.upper().replace("-", "_") for option in options}

    def serve(self, values):
        """Starts a server with these variables, and returns its URL."""
        values = {name: value for name, value in values.items() if value is not None}
        server = subprocess.Popen(
            [PROGRAM, "serve", "--port", "0", "--data", "none", "--log-level", "error"], text=True,
            stdout=subprocess.PIPE, env={"PATH": os.environ["PATH"], **values})
        self.addCleanup(server.communicate)
        self.addCleanup(server.terminate)
        found = re.search(r"http://\S+", server.stdout.readline())
        self.assertTrue(found, values)
        return found[0]

    def test_variables_are_settings_with_valid_values(self):
        for name in ("compose.yaml", "compose.cluster.yaml", "operations/compose.yaml",
                     "kubernetes/vat.yaml", "kubernetes/agones.yaml"):
            with self.subTest(name):
                found = variables(documents(name))
                self.assertTrue(found)
                self.assertEqual(set(found) - OTHER_VARIABLES - self.settings, set())
                elsewhere = {"VAT_CLUSTER", "VAT_NODE", "VAT_PUBLIC_URL"}  # need NATS servers
                self.serve({name: value for name, value in found.items()
                            if name not in elsewhere and not re.match("[$/]", str(value))})

    def test_nodes_of_kubernetes(self):
        items = documents("kubernetes/vat.yaml")
        (nodes,), (scaler,), (ingress,), (config,) = (
            by_kind(items, kind) for kind in
            ("StatefulSet", "HorizontalPodAutoscaler", "Ingress", "ConfigMap"))
        name = nodes["metadata"]["name"]
        self.assertEqual(scaler["spec"]["scaleTargetRef"]["name"], name)
        pod = nodes["spec"]["template"]
        (container,) = pod["spec"]["containers"]
        services = {item["metadata"]["name"]: item["spec"] for item in by_kind(items, "Service")}
        self.assertIn(nodes["spec"]["serviceName"], services)
        pods = [f"{name}-{number}" for number in range(scaler["spec"]["maxReplicas"])]
        for each in pods:
            selector = services[each]["selector"]
            self.assertEqual(selector, {"statefulset.kubernetes.io/pod-name": each})
        self.assertLessEqual(services[name]["selector"].items(), pod["metadata"]["labels"].items())

        targets = {rule["host"]: rule["http"]["paths"][0]["backend"]["service"]["name"]
                   for rule in ingress["spec"]["rules"]}
        url = variables(container)["VAT_PUBLIC_URL"]
        domain = re.fullmatch(r"wss://\$\(VAT_NODE\)\.(.+)/ws", url)[1]
        self.assertEqual(targets, {domain: name, **{f"{pod}.{domain}": pod for pod in pods}})
        data = config["data"]
        self.assertEqual(data["VAT_PUBLIC_NAME"].split(","), list(targets))
        self.assertEqual(data["VAT_ALLOW_ORIGIN"].split(","), [f"https://{host}" for host in targets])

        stop = int(container["lifecycle"]["preStop"]["exec"]["command"][1])
        drain = int(data["VAT_DRAIN_SECONDS"])
        self.assertGreaterEqual(pod["spec"]["terminationGracePeriodSeconds"], 2 * (stop + drain))
        (port,) = container["ports"]
        address = self.serve({})
        for probe in ("readinessProbe", "livenessProbe"):
            request = container[probe]["httpGet"]
            self.assertEqual(request["port"], port["name"])
            with urllib.request.urlopen(address + request["path"].lstrip("/")) as answer:
                self.assertEqual(answer.status, 200)

    def test_nats_of_kubernetes(self):
        items = documents("kubernetes/vat.yaml")
        (config,) = by_kind(items, "ConfigMap")
        (values,) = documents("kubernetes/nats.yaml")
        replicas = values["config"]["cluster"]["replicas"]
        self.assertEqual(config["data"]["VAT_CLUSTER"].split(","),
                         [f"nats://nats-{i}.nats-headless:4222" for i in range(replicas)])

    def test_game_servers_of_agones(self):
        fleet, scaler = documents("kubernetes/agones.yaml")
        self.assertEqual(scaler["spec"]["fleetName"], fleet["metadata"]["name"])
        server = fleet["spec"]["template"]["spec"]
        (container,) = server["template"]["spec"]["containers"]
        self.assertIn(f"COPY docker/kubernetes/agones.sh {container['command'][0]}\n",
                      (FOLDER / "Dockerfile").read_text())
        self.assertEqual(variables(container)["VAT_MAX_SESSIONS"], "1")

    def test_nodes_of_compose_are_behind_the_proxy(self):
        (compose,) = documents("compose.cluster.yaml")
        proxy = compose["configs"]["proxy"]["content"]
        (port,) = compose["services"]["proxy"]["ports"]
        outside = port.split(":")[1]
        nodes = [name for name in compose["services"]
                 if "VAT_NODE" in compose["services"][name].get("environment", {})]
        self.assertEqual(len(nodes), 3)
        for node in nodes:
            values = compose["services"][node]["environment"]
            self.assertEqual(values["VAT_NODE"], node)
            host = f"{node}.localhost:{outside}"
            self.assertEqual(values["VAT_PUBLIC_URL"], f"ws://{host}/ws")
            self.assertIn(host, values["VAT_PUBLIC_NAME"].split(","))
            self.assertIn(f"http://{host}", values["VAT_ALLOW_ORIGIN"].split(","))
            self.assertRegex(proxy, rf"http://{host} {{\s+reverse_proxy {node}:8080\s")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]], verbosity=2)
