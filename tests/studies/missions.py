"""Short missions without inertia, to be compared."""

LINE = """
cardume: 1
name: line
duration: 40 s
path: {type: line, length: 100 m}
formation: {speed: 0.5 m/s}
current: {type: uniform, speed: 0.1 m/s, towards: 90 deg}
vehicles: [{name: a, model: kinematic, sensors: ideal, start: {cross_track: 3 m, speed: 0.5 m/s}}]
guidance: {law: line_of_sight, lookahead: 2 m}
transient: {threshold: 1 m, hold: 1 s}
"""

NOISY = LINE.replace("sensors: ideal", "sensors: {gnss: {sigma: 0.2 m}, ahrs: {}, depth: {}, thruster_speed: {}}")
NOISY = NOISY.replace("threshold: 1 m", "threshold: 2 m")
