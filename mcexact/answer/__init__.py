"""Answers about systems, each its own certificate, and the sentences that follow from them."""
