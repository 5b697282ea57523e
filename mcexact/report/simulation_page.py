"""A self-contained HTML page of a simulation."""

from __future__ import annotations

import base64

_PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>{{ title }}</title>
<style>
body { font-family: sans-serif; max-width: 70em; margin: 2em auto; padding: 0 1em; }
table { border-collapse: collapse; }
td, th { border: 1px solid #ccc; padding: 0.2em 0.6em; text-align: right; }
p.warning { border-left: 0.3em solid #c60; padding-left: 0.8em; }
img { max-width: 100%; }
</style>
</head>
<body>
<h1>{{ title }}</h1>
{% for line in facts %}<p>{{ line }}</p>
{% endfor %}{% for line in warnings %}<p class="warning">{{ line }}</p>
{% endfor %}
<img alt="state, errors and spectrum" src="data:image/png;base64,{{ image }}">
<table>
<tr>{% for name in columns %}<th>{{ name }}</th>{% endfor %}</tr>
{% for row in rows %}<tr>{% for entry in row %}<td>{{ entry }}</td>{% endfor %}</tr>
{% endfor %}</table>
</body>
</html>
"""


def simulation_page(
    title: str,
    facts: list[str],
    warnings: list[str],
    columns: tuple[str, ...],
    rows: tuple[tuple[str, ...], ...],
    png: bytes,
) -> str:
    """Return the text of the page, in which all inserted texts are escaped."""
    from jinja2 import Environment

    template = Environment(autoescape=True).from_string(_PAGE)
    return template.render(
        title=title,
        facts=facts,
        warnings=warnings,
        columns=columns,
        rows=rows,
        image=base64.b64encode(png).decode("ascii"),
    )
