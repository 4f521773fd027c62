"""``hdrive-mbs effects``: the library of effects."""

from __future__ import annotations

import dataclasses
import inspect
from pathlib import Path
from typing import Annotated

import typer

from hdrive_mbs.cli.options import JsonFile
from hdrive_mbs.cli.output import print_table, write_json
from hdrive_mbs.cli.scene_source import effect_types, open_scene
from hdrive_mbs.quantities import FIELDS
from hdrive_mbs.quantity import Quantity


def effects(
    scene: Annotated[Path | None, typer.Argument(metavar="[SCENE]", help="List the places of this scene for each effect too.")] = None,
    json: JsonFile = None,
) -> None:
    """List the effects that can be added to a scene: law, parameters, ranges, places."""
    network = None if scene is None else open_scene(scene).network()
    library = []
    for name, kind in effect_types().items():
        if not kind.tried:
            continue
        fields = []
        for field in dataclasses.fields(kind):
            quantity: Quantity | None = field.metadata.get("quantity")
            entry: dict[str, object] = {"name": field.name}
            if quantity is not None:
                entry |= {key: getattr(quantity, key) for key in ("unit", "low", "high", "above", "typical", "doc")}
            else:
                entry |= {"doc": field.metadata.get("doc", "")}
            entry["required"] = field.default is dataclasses.MISSING
            entry["default"] = None if field.default is dataclasses.MISSING else field.default
            fields.append(entry)
        library.append(
            {
                "effect": name,
                "family": kind.family,
                "kind": kind.kind,
                "acts_on": kind.acts_on,
                "signature": kind.signature,
                "law": inspect.cleandoc(kind.__doc__ or "").partition(f"\n\n{FIELDS}")[0],
                "parameters": fields,
                "places": [] if network is None else list(kind.places(network)),
            }
        )
    write_json(json, library)
    if json != "-":
        told = ("effect", "family", "acts_on", "signature")
        rows = [[*(str(item[key]) for key in told), _needs(item["parameters"])] for item in library]
        print_table("effects", ["effect", "family", "acts on", "seen in a record as", "parameters (required first)"], rows)


def _needs(parameters: object) -> str:
    assert isinstance(parameters, list)
    ordered = sorted(parameters, key=lambda entry: not entry["required"])
    return ", ".join(f"{entry['name']} [{entry['unit']}]" if entry.get("unit", "1") != "1" else entry["name"] for entry in ordered)
