"""Position estimators: `direct`, `reset`, `reset_compensated`, `kalman_replay`."""

from cardume.onboard.estimation.position.base import estimate_position, position_law
from cardume.onboard.estimation.position.direct import direct
from cardume.onboard.estimation.position.kalman_replay import kalman_replay
from cardume.onboard.estimation.position.reset import reset
from cardume.onboard.estimation.position.reset_compensated import reset_compensated

__all__ = ["direct", "estimate_position", "kalman_replay", "position_law", "reset", "reset_compensated"]
