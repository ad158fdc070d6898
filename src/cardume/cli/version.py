"""Which cardume this is."""


def version() -> str:
    """The version that is installed."""
    from importlib import metadata  # takes longer than all else that a command line with a mistake in it needs

    try:
        return metadata.version("cardume")
    except metadata.PackageNotFoundError:
        return "unknown"
