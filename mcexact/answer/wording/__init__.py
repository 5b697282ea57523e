"""Every sentence that the commands print about a system: its words, its premises, its theorem."""
