"""What agents must send each other: how much, at least, and over which links."""
