"""What nature and devices do: currents, sensors, acoustics; it never sees a controller."""
