"""Many missions from one: arms of a comparison, flown under common random numbers, and what their numbers say."""
