"""The sentences of `mcexact allocate --arcs`: the premise is the certificate that it writes."""

from __future__ import annotations

from mcexact.answer.template import Template

_LINKS = ("minimal_communication",)

LEAST = Template(
    "allocate-links",
    "{name:name}: {price:links} to add so that {scope:scope}, sending {what:carried}{time:instant}",
    _LINKS,
)
NONE_NEEDED = Template(
    "allocate-no-links-needed",
    "{name:name}: no links to add so that {scope:scope}, sending {what:carried}{time:instant}",
    _LINKS,
)
IMPOSSIBLE = Template(
    "allocate-no-links",
    "{name:name}: no links that may be added are enough so that {scope:scope}, sending "
    "{what:carried}",
    _LINKS,
)
ROW = Template("allocate-link", "{start:name} | {end:name} | {cost:number}", _LINKS)
TOTAL = Template("allocate-links-total", "total | – | {cost:number}", _LINKS)
PROOF = Template(
    "allocate-links-proof",
    "proved with {cuts:count obstruction} and a branch tree of {nodes:count node}",
    _LINKS,
)
