"""What the browser gets: one page, its style, its scripts."""
