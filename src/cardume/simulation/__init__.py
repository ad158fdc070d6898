"""The engine: joins what runs aboard with the world, and is the only place that sees both."""
