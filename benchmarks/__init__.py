"""How fast cardume is: `make bench`, or `python -m benchmarks --help`."""
