"""What is said of a system: values in words, and the sentences that certified claims make true."""
