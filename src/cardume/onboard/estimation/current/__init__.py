"""Current observers."""

from cardume.onboard.estimation.current.base import current_observer_law, observe
from cardume.onboard.estimation.current.complementary import complementary
from cardume.onboard.estimation.current.from_position import from_position
from cardume.onboard.estimation.current.none import none

__all__ = ["complementary", "current_observer_law", "from_position", "none", "observe"]
