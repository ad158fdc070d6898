"""The command line: one file per command, nothing but words in and words out."""
