"""Many missions from one: the arms of a comparison, flown under common random numbers, and what their numbers say."""
