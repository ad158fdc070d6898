"""`python -m benchmarks.reference`: the reference workload alone; options as those of `python -m benchmarks`."""

import sys

from benchmarks.__main__ import main

main(["--only", "reference", "--only", "sizes", *sys.argv[1:]])
