"""Which cardume this is."""

from importlib import metadata


def version() -> str:
    """The version that is installed."""
    try:
        return metadata.version("cardume")
    except metadata.PackageNotFoundError:
        return "unknown"
