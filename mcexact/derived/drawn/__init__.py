"""Systems and graphs of known structure, drawn from a seed or by whoever else can choose."""
