"""Which modes stay under decentralized control, why, and what gains do with the others."""
