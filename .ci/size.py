"""How much disk an installation of cardume without extras takes: itself and what it needs, per distribution."""

import re
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from pathlib import Path

# Of the markers only "extra ==" is read; for the others (system, Python version) what is installed decides.
NAME = re.compile(r"^[A-Za-z0-9._-]+")


def needed(name: str, found: dict[str, Distribution]) -> dict[str, Distribution]:
    """The distribution of that name and all it needs, as installed here."""
    key = re.sub(r"[-_.]+", "-", name).lower()
    if key not in found:
        try:
            found[key] = distribution(name)
        except PackageNotFoundError:  # needed on another system or Python only
            return found
        for requirement in found[key].requires or ():
            if "extra ==" not in requirement:
                needed(NAME.match(requirement)[0], found)
    return found


def installed_bytes(package: Distribution) -> int:
    """Bytes of the files that the installer recorded, compiled Python included."""
    paths = {Path(package.locate_file(file)).resolve() for file in package.files or ()}
    return sum(path.stat().st_size for path in paths if path.is_file())


def own_bytes() -> int:
    """Bytes of cardume's sources, which an editable installation does not record."""
    folder = Path(__file__).parents[1] / "src"
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file() and "__pycache__" not in path.parts)


def main() -> None:
    """Print a line for each distribution, largest first, and the sum."""
    sizes = {name: installed_bytes(package) for name, package in needed("cardume", {}).items()}
    sizes["cardume"] += own_bytes()
    for name, size in sorted(sizes.items(), key=lambda row: -row[1]):
        print(f"{size / 1e6:8.1f} MB  {name}")
    print(f"{sum(sizes.values()) / 1e6:8.1f} MB  together, {len(sizes)} distributions")


if __name__ == "__main__":
    main()
