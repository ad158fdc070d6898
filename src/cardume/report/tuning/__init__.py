"""A tuning as a table, sentences and a figure."""
