"""Writes the tables of variables, parameters and failsafe actions into their pages while MkDocs builds the book.

The variables come from modelDescription.xml.
The parameters come from the JSON that `lmpc-sitl --list-parameters=json` prints, in the file named by LMPC_BOOK_PARAMETERS;
with `--autopilot ardupilot`, in that named by LMPC_BOOK_ARDUPILOT_PARAMETERS.
"""

import json
import os
import re
from pathlib import Path
from xml.etree import ElementTree

from mkdocs.exceptions import PluginError

ROOT = Path(__file__).resolve().parent.parent
FMU_VARIABLES = "<!-- fmu-variables -->"
VEHICLE_PARAMETERS = "<!-- vehicle-parameters -->"
#: Markers of the actions of each autopilot, and where its parameters are.
ACTIONS = {
    "<!-- failsafe-actions -->": "LMPC_BOOK_PARAMETERS",
    "<!-- ardupilot-failsafe-actions -->": "LMPC_BOOK_ARDUPILOT_PARAMETERS",
}
HEADINGS = {
    "input": "Inputs",
    "output": "Outputs",
    "local": "Local variables",
    "parameter": "Parameters",
    "calculatedParameter": "Calculated parameters",
}


def on_page_markdown(markdown: str, **_) -> str:
    if FMU_VARIABLES in markdown:
        return markdown.replace(FMU_VARIABLES, fmu_variables())
    if VEHICLE_PARAMETERS in markdown:
        return markdown.replace(VEHICLE_PARAMETERS, vehicle_parameters())
    for marker, variable in ACTIONS.items():
        if marker in markdown:
            markdown = markdown.replace(marker, actions(markdown, variable))
    return markdown


def fmu_variables() -> str:
    description = ElementTree.parse(ROOT / "modelDescription.xml").getroot()
    units = {kind.get("name"): kind[0].get("unit", "") for kind in description.find("TypeDefinitions")}
    rows = {causality: [] for causality in HEADINGS}
    for variable in description.find("ModelVariables"):
        if variable.get("causality") in rows:
            rows[variable.get("causality")].append(variable)
    lines = []
    for causality, variables in rows.items():
        if not variables:
            continue
        lines += ["", f"## {HEADINGS[causality]}", "", "| name | default | allowed | meaning |", "| --- | --- | --- | --- |"]
        for variable in variables:
            value = variable[0]
            bounds = f"{value.get('min')} to {value.get('max')}" if value.get("min") else ""
            unit = value.get("unit") or units.get(value.get("declaredType"), "")
            tunable = "; tunable" if causality == "parameter" and variable.get("variability") == "tunable" else ""
            allowed = f"{bounds} {unit}".strip()
            lines.append(row(f"`{variable.get('name')}`", value.get("start", ""), allowed, variable.get("description", "") + tunable))
    return "\n".join(lines)


def parameters(variable: str) -> list[dict]:
    path = os.environ.get(variable)
    if path is None:
        raise PluginError(f"{variable} must name the output of `lmpc-sitl --list-parameters=json`; `cargo xtask book` sets it")
    return json.loads(Path(path).read_text(encoding="utf-8"))


def actions(page: str, variable: str) -> str:
    """The values of the parameters that the page names; defaults are bold."""
    named = set(re.findall(r"`([A-Z][A-Z0-9_]+)`", page))
    lines = ["| parameter | what it chooses | values |", "| --- | --- | --- |"]
    for parameter in parameters(variable):
        if parameter["name"] in named and parameter["values"]:
            values = [f"{each['value']} {each['name']}" for each in parameter["values"]]
            shown = [f"**{text}**" if each["value"] == parameter["value"] else text for text, each in zip(values, parameter["values"])]
            lines.append(row(f"`{parameter['name']}`", parameter["description"], ", ".join(shown)))
    if len(lines) == 2:
        raise PluginError(f"the page of failsafes names none of the parameters in {variable}")
    return "\n".join(lines)


def vehicle_parameters() -> str:
    groups = {}
    for parameter in parameters("LMPC_BOOK_PARAMETERS"):
        groups.setdefault(parameter["group"], []).append(parameter)
    lines = []
    for group, members in groups.items():
        lines += ["", f"## {group}", "", "| name | default | allowed | meaning |", "| --- | --- | --- | --- |"]
        lines += [row(names(parameter), *(parameter_cell(parameter, key) for key in ("value", "range", "description")))
                  for parameter in members]
    return "\n".join(lines)


def names(parameter: dict) -> str:
    dotted = parameter.get("dotted_name")
    return f"`{parameter['name']}`" + (f"<br>`{dotted}`" if dotted else "")


def parameter_cell(parameter: dict, key: str) -> str:
    value = parameter.get(key)
    if key == "range":
        return f"{parameter['min']:g} to {parameter['max']:g} {parameter['unit']}".strip()
    return f"{value:g}" if isinstance(value, float) else str(value if value is not None else "")


def row(*cells: str) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"
