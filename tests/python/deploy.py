"""Whether the files of deploy/ fit together: what is mounted is there, what is named is provisioned."""

import json
import pathlib
import re
import sys

import yaml

deploy = pathlib.Path(sys.argv[1])
compose = yaml.safe_load((deploy / "compose.yaml").read_text())
services = compose["services"]
assert set(services) == {"stickslip", "postgres", "prometheus", "grafana"}
for name, service in services.items():
    for mount in service.get("volumes", []):
        source = mount.split(":")[0]
        there = (deploy / source).exists() if source.startswith(".") else source in compose["volumes"]
        assert there, f"{name}: {mount}"
    for port in service.get("ports", []):
        assert port.startswith("127.0.0.1:"), f"{name}: {port} is open to others"
    assert set(service.get("depends_on", [])) <= set(services), name

provisioning = deploy / "grafana" / "provisioning"
sources = yaml.safe_load((provisioning / "datasources" / "stickslip.yaml").read_text())["datasources"]
kinds = {source["uid"]: source["type"] for source in sources}
hosts = [source["url"].removeprefix("http://").split(":")[0] for source in sources if "url" in source]
assert set(hosts) <= set(services), hosts
targets = yaml.safe_load((deploy / "prometheus.yml").read_text())["scrape_configs"][0]["static_configs"][0]["targets"]
assert targets == ["stickslip:8080"], targets

# Each rule is beside the configuration in the container, names a metric of the page of operation, and says what to do.
rules = yaml.safe_load((deploy / "prometheus.yml").read_text())["rule_files"]
mounted = {mount.split(":")[1] for mount in services["prometheus"]["volumes"]}
assert {f"/etc/prometheus/{name}" for name in rules} <= mounted, rules
metrics = (deploy / ".." / "docs" / "operation.md").read_text()
for rule in yaml.safe_load((deploy / rules[0]).read_text())["groups"][0]["rules"]:
    named = [name.removesuffix("_bucket") for name in re.findall(r"(?:stickslip|process)_\w+", rule["expr"])]
    assert (named or rule["expr"].startswith("up{")) and all(f"`{name}" in metrics for name in named), rule
    assert rule["annotations"]["summary"], rule

provider = yaml.safe_load((provisioning / "dashboards" / "stickslip.yaml").read_text())["providers"][0]
mounts = {mount.split(":")[1]: mount.split(":")[0] for mount in services["grafana"]["volumes"]}
boards = sorted((deploy / mounts[provider["options"]["path"]]).glob("*.json"))
assert len(boards) == 2, boards
for board in boards:
    found = json.loads(board.read_text())
    used = [target["datasource"] for panel in found["panels"] for target in panel["targets"]]
    used += [variable["datasource"] for variable in found["templating"]["list"] if variable["type"] == "query"]
    assert used and all(kinds[source["uid"]] == source["type"] for source in used), board
    assert len({panel["id"] for panel in found["panels"]}) == len(found["panels"]), board
    # What a data source may ask includes the service that the dashboard names by default.
    for variable in found["templating"]["list"]:
        if variable["name"] == "service":
            allowed = next(source for source in sources if source["uid"] == "infinity")["jsonData"]["allowedHosts"]
            assert variable["query"] == variable["current"]["value"] and variable["query"] in allowed, board
home = services["grafana"]["environment"]["GF_DASHBOARDS_DEFAULT_HOME_DASHBOARD_PATH"]
assert home.startswith(provider["options"]["path"]), home
print("deploy fits together")
