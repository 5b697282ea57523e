"""Decentralized control and control of extended systems, over links with and without delays."""
