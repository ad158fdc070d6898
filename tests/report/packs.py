"""Numbers as pages carry them, back."""

import base64
from collections.abc import Mapping

import numpy as np


def unpacked(given: Mapping[str, str]) -> np.ndarray:
    """An array from Plotly's own notation."""
    return np.frombuffer(base64.b64decode(given["bdata"]), dtype=f"<{given['dtype']}")
