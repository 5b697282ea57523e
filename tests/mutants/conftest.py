"""What imports Cosmic Ray, which is not always there, is not looked at for tests."""

collect_ignore_glob = ["[!t]*.py"]
