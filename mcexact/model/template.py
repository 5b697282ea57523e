"""A system file to start from, with every key explained."""

from __future__ import annotations

import json

_EXPLAINED = (
    "Replace this text by the source of the numbers. time: continuous or discrete. "
    'A: n rows of n numbers, such as 2, -0.5, 1e-3 or "1/3", read exactly as typed. '
    "channels: the name of each, B (n rows, a column per input) and C (a row per output). "
    "neighbors: for each agent those that it receives messages from; it may be left out. "
    'In discrete time, sample_time is a number, and delays {"valve": {"pump": 2}} says that '
    "messages from pump reach valve after 2 steps. A large matrix can be an object: "
    '{"shape": [n, n], "entries": [[row, column, value]]}, rows and columns from 0. '
    "name and source are free texts."
)
_YAML = """\
# A system x' = A x + B_1 u_1 + B_2 u_2, y_i = C_i x, for mcexact.  Numbers are read exactly as they
# are typed: 2, -0.5, 1e-3, or "1/3" as a text.
format: mcexact-system/1       # as it is
name: two tanks                # a free text; may be left out
source: my own measurements    # a free text; may be left out
time: continuous               # or discrete: x(t+1) = A x + ...
# sample_time: 0.1             # in discrete time, if it is known; no decision uses it
A:                             # n rows of n numbers
- [-0.02, 0.02]
- [0.02, "-1/30"]
channels:                      # one for each agent, which sets u_i and measures y_i
- name: pump
  B: [[0.5], [0]]              # n rows, with a column for each input of this agent
  C: [[1, 0]]                  # a row of n numbers for each output of this agent
- name: valve
  B: [[0], [0.4]]
  C: [[0, 1]]
neighbors:                     # for each agent, whose messages it receives; may be left out
  pump: [valve]
  valve: [pump]
# delays:                      # in discrete time: messages from valve reach pump after 2 steps
#   pump: {valve: 2}
"""


def template(kind: str) -> str:
    """The text of a starting file, JSON or YAML.

    Examples
    --------
    >>> from mcexact.model.system_file import read_system
    >>> read_system(template("json"))
    MultiChannelSystem(n=2, m=2, continuous time, channels: 'pump', 'valve')
    """
    if kind == "yaml":
        return _YAML
    lines = [
        ("format", "mcexact-system/1"),
        ("name", "two tanks"),
        ("source", _EXPLAINED),
        ("time", "continuous"),
    ]
    head = "".join(f'  "{key}": {json.dumps(value)},\n' for key, value in lines)
    return (
        "{\n" + head + '  "A": [[-0.02, 0.02], [0.02, "-1/30"]],\n'
        '  "channels": [\n'
        '    {"name": "pump",  "B": [[0.5], [0]], "C": [[1, 0]]},\n'
        '    {"name": "valve", "B": [[0], [0.4]], "C": [[0, 1]]}\n'
        "  ],\n"
        '  "neighbors": {"pump": ["valve"], "valve": ["pump"]}\n'
        "}\n"
    )
