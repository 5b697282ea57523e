"""Systems and graphs of known structure, drawn from a seed or another source of choices."""
