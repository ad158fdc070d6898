"""The one-file report: what a run was and did, to look at in any browser, without a network."""
