"""The laboratory: a page on this machine that flies a mission again while a slider moves."""
