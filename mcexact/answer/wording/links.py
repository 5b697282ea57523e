"""The sentences of `mcexact allocate --links`."""

from __future__ import annotations

from mcexact.answer.template import Template

LEAST = Template(
    "allocate-links",
    "{name:name}: {price:links} to add so that {scope:scope}, sending {what:carried}{time:instant}",
)
NONE_NEEDED = Template(
    "allocate-no-links-needed",
    "{name:name}: no links to add so that {scope:scope}, sending {what:carried}{time:instant}",
)
IMPOSSIBLE = Template(
    "allocate-no-links",
    "{name:name}: no links that may be added suffice so that {scope:scope}, sending {what:carried}",
)
ROW = Template("allocate-link", "{start:name} | {end:name} | {cost:number}")
TOTAL = Template("allocate-links-total", "total | – | {cost:number}")
PROOF = Template(
    "allocate-links-proof",
    "proved with {cuts:count obstruction} and a branch tree of {nodes:count node}",
)
