"""The one-file report of a study, to look at in any browser, without a network."""
