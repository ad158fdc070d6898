"""What was flown, for other people's viewers: tracks, tables and ROS 2 bags, made from a log.

Each format is one file with one function from a `Flight` to bytes.
"""
