"""These files test the tests; Cosmic Ray, which some of them import, is only there for them."""

collect_ignore_glob = ["*.py"]
