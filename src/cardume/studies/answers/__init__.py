"""What a study says: distributions, chances, influences, regions, differences, worst runs; how sure it is.

`results.py` reads the dataset of a study; every other file answers one question about it.
"""
