"""The templates of all sentences that the commands print about a system, with their theorems."""
